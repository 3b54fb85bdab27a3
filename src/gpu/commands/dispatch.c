// Compute dispatches.
#include "gpu/vk.h"

// The pipeline with its bindings ready to record; NULL: nothing is to be recorded.
static struct pipeline *prepare(struct gpu_cmd *cmd, gpu_pipeline handle,
                                const struct gpu_binding *bindings, int binding_count,
                                size_t push_bytes, struct bound_set *set)
{
    if (cmd->gpu->lost || cmd->broken) return NULL;
    struct pipeline *pipeline = pipeline_get(cmd->gpu, handle);
    if (!pipeline || pipeline->graphics) {
        gpu_misuse(cmd->gpu, "dispatch: the pipeline is %s", pipeline ? "for graphics" : "none");
        return NULL;
    }
    if (cmd->rendering.open) {
        gpu_misuse(cmd->gpu, "dispatch of %s: not inside a rendering", pipeline->name);
        return NULL;
    }
    hazard_next_op(cmd);
    return bind_prepare(cmd, pipeline, bindings, binding_count, push_bytes, set) ? pipeline : NULL;
}

void gpu_dispatch(struct gpu_cmd *cmd, gpu_pipeline handle, const struct gpu_binding *bindings,
                  int binding_count, const void *push, size_t push_bytes, uint32_t groups_x,
                  uint32_t groups_y, uint32_t groups_z)
{
    const uint32_t *most = cmd->gpu->limits.max_groups;
    if (!groups_x || !groups_y || !groups_z) return;
    if (groups_x > most[0] || groups_y > most[1] || groups_z > most[2]) {
        struct pipeline *pipeline = pipeline_get(cmd->gpu, handle);
        host_fail(cmd->gpu->host, FAIL_ARGUMENT,
                  "gpu dispatch of %s: %u x %u x %u groups, at most %u x %u x %u",
                  pipeline ? pipeline->name : "none", groups_x, groups_y, groups_z, most[0],
                  most[1], most[2]);
        return;
    }
    struct bound_set set;
    struct pipeline *pipeline = prepare(cmd, handle, bindings, binding_count, push_bytes, &set);
    if (!pipeline) return;
    hazard_flush(cmd);
    bind_record(cmd, pipeline, &set, push);
    cmd->gpu->vk.CmdDispatch(cmd->buffer, groups_x, groups_y, groups_z);
}

void gpu_dispatch_indirect(struct gpu_cmd *cmd, gpu_pipeline handle,
                           const struct gpu_binding *bindings, int binding_count, const void *push,
                           size_t push_bytes, gpu_buffer arguments, size_t offset)
{
    struct bound_set set;
    struct pipeline *pipeline = prepare(cmd, handle, bindings, binding_count, push_bytes, &set);
    if (!pipeline) return;
    struct buffer *buffer = buffer_get(cmd->gpu, arguments);
    const size_t size = sizeof(VkDispatchIndirectCommand);
    if (!buffer || offset % 4 || buffer->bytes < size || offset > buffer->bytes - size) {
        gpu_misuse(cmd->gpu, "dispatch of %s: no arguments at %zu", pipeline->name, offset);
        return;
    }
    hazard_buffer(cmd, buffer, &(struct access){ .stages = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT });
    hazard_flush(cmd);
    bind_record(cmd, pipeline, &set, push);
    cmd->gpu->vk.CmdDispatchIndirect(cmd->buffer, buffer->handle, offset);
}
