// Scopes: a debug label and a pair of timestamps. The whole frame is the outermost one.
#include "gpu/vk.h"

#include <stdio.h>
#include <string.h>

enum { STACK = sizeof(((struct scopes *)0)->stack) / sizeof(uint32_t) };
static const uint32_t NOT_TIMED = UINT32_MAX;

bool scopes_init(struct gpu *gpu, struct scopes *scopes, const char *name)
{
    if (!gpu->limits.timestamps) return true;
    if (!VK_CALL(gpu, CreateQueryPool, gpu->device,
                 &(VkQueryPoolCreateInfo){ .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                           .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                           .queryCount = 2 * MAX_SCOPES },
                 gpu->allocator, &scopes->queries)) {
        return false;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_QUERY_POOL, scopes->queries, name);
    return true;
}

// A timestamp after completion of all earlier commands.
static uint32_t stamp(struct gpu_cmd *cmd)
{
    if (!cmd->scopes.queries) return NOT_TIMED;
    uint32_t query = cmd->scopes.query_count++;
    cmd->gpu->vk.CmdWriteTimestamp2(cmd->buffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                    cmd->scopes.queries, query);
    return query;
}

static void push(struct gpu_cmd *cmd, const char *name)
{
    struct scopes *s = &cmd->scopes;
    uint32_t index = NOT_TIMED;
    if (s->count < MAX_SCOPES) {
        index = s->count++;
        struct scope *scope = &s->list[index];
        *scope = (struct scope){ .last_query = NOT_TIMED };
        snprintf(scope->name, sizeof scope->name, "%s", name);
        scope->first_query = stamp(cmd);
    } else if (s->count == MAX_SCOPES) {
        s->count++;
        host_log(cmd->gpu->host, LOG_WARNING, "gpu scope %s: only %d are timed in a frame", name,
                 MAX_SCOPES);
    }
    if (s->depth > 0 && s->depth <= STACK && s->stack[s->depth - 1] != NOT_TIMED) {
        s->list[s->stack[s->depth - 1]].outer = true;
    }
    if (s->depth < STACK) s->stack[s->depth] = index;
    s->depth++;
}

static void pop(struct gpu_cmd *cmd)
{
    struct scopes *s = &cmd->scopes;
    s->depth--;
    if (s->depth >= STACK || s->stack[s->depth] == NOT_TIMED) return;
    s->list[s->stack[s->depth]].last_query = stamp(cmd);
}

void scopes_start(struct gpu_cmd *cmd)
{
    struct scopes *s = &cmd->scopes;
    s->count = s->query_count = s->depth = 0;
    if (s->queries) cmd->gpu->vk.ResetQueryPool(cmd->gpu->device, s->queries, 0, 2 * MAX_SCOPES);
    push(cmd, "frame");
}

void scopes_stop(struct gpu_cmd *cmd)
{
    if (cmd->scopes.depth > 1)
        gpu_misuse(cmd->gpu, "scope: %u are still open at the frame's end", cmd->scopes.depth - 1);
    while (cmd->scopes.depth > 1) gpu_scope_end(cmd);
    pop(cmd);
}

void gpu_scope_begin(struct gpu_cmd *cmd, const char *name)
{
    char full[NAME_SIZE];
    name = owner_name(cmd->gpu, name, full);
    if (cmd->gpu->vk.CmdBeginDebugUtilsLabelEXT) {
        cmd->gpu->vk.CmdBeginDebugUtilsLabelEXT(
            cmd->buffer, &(VkDebugUtilsLabelEXT){ .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                                  .pLabelName = name });
    }
    push(cmd, name);
    cmd->gpu->counters.passes++;
}

void gpu_scope_end(struct gpu_cmd *cmd)
{
    if (cmd->scopes.depth < 2) {
        gpu_misuse(cmd->gpu, "scope: none is open");
        return;
    }
    pop(cmd);
    if (cmd->gpu->vk.CmdEndDebugUtilsLabelEXT) cmd->gpu->vk.CmdEndDebugUtilsLabelEXT(cmd->buffer);
}

static struct gpu_timing *timing_of(struct frame_times *times, const char *name)
{
    for (int i = 0; i < times->count; i++) {
        if (strcmp(times->list[i].name, name) == 0) return &times->list[i];
    }
    struct gpu_timing *timing = &times->list[times->count++];
    *timing = (struct gpu_timing){ .ms = 0 };
    snprintf(timing->name, sizeof timing->name, "%s", name);
    return timing;
}

static void collect(const struct gpu_cmd *cmd, const uint64_t *ticks, struct frame_times *times)
{
    const struct scopes *s = &cmd->scopes;
    if (cmd->serial <= times->serial) return; // a newer frame was completed before
    times->serial = cmd->serial;
    times->count = 0;
    uint32_t count = s->count < MAX_SCOPES ? s->count : MAX_SCOPES;
    for (uint32_t i = 0; i < count; i++) {
        const struct scope *scope = &s->list[i];
        if ((scope->outer && i > 0) || scope->last_query == NOT_TIMED) continue;
        uint64_t passed =
            (ticks[scope->last_query] - ticks[scope->first_query]) & cmd->gpu->tick_mask;
        timing_of(times, scope->name)->ms += (double)passed * cmd->gpu->ns_per_tick * 1e-6;
    }
}

void scopes_collect(struct gpu_cmd *cmd)
{
    struct gpu *gpu = cmd->gpu;
    const struct scopes *s = &cmd->scopes;
    uint64_t ticks[2 * MAX_SCOPES];
    if (!s->queries || !s->query_count) return;
    if (gpu->vk.GetQueryPoolResults(gpu->device, s->queries, 0, s->query_count, sizeof ticks, ticks,
                                    sizeof *ticks, VK_QUERY_RESULT_64_BIT) != VK_SUCCESS) {
        return;
    }
    collect(cmd, ticks, &gpu->times);
    struct client *client = client_find(gpu, cmd->client);
    if (client) collect(cmd, ticks, &client->times);
}
