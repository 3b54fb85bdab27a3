// Plans: the list of stages that a technique makes.
#include "bake/bake_state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FIRST_CAPACITY = 16, MAX_WAVES = 1000 };

static bool fail_stage(struct bake_plan *plan, const struct bake_stage *stage, const char *why)
{
    return host_fail(plan->host, FAIL_ARGUMENT, "cannot plan the stage %s: %s", stage->name, why);
}

static bool name_is_free(const struct bake_plan *plan, const char *output)
{
    for (int s = 0; s < plan->stage_count; s++)
        for (int i = 0; i < plan->stages[s].what.output_count; i++)
            if (strcmp(plan->stages[s].outputs[i].what.name, output) == 0) return false;
    return true;
}

static bool check_output(struct bake_plan *plan, const struct bake_stage *stage,
                         const struct bake_output *output)
{
    size_t bytes;
    if (!output->name || !output->name[0]) return fail_stage(plan, stage, "an output has no name");
    if (!name_is_free(plan, output->name)) return fail_stage(plan, stage, "an output exists twice");
    if (output->rank < 0 || output->rank > TENSOR_MAX_RANK)
        return fail_stage(plan, stage, "the rank of an output is not 0 to 8");
    if (output->reduction == BAKE_SUM && output->type != TENSOR_F32)
        return fail_stage(plan, stage, "a sum is not F32");
    if (output->keep <= stage->wave) return fail_stage(plan, stage, "an output is read by no wave");
    if (!tensor_extent(output->type, output->rank, output->shape, &bytes) ||
        (output->reduction == BAKE_SUM && !size_mul(bytes, stage->task_count, &bytes)))
        return fail_stage(plan, stage, "an output is too large");
    return true;
}

static bool check_stage(struct bake_plan *plan, const struct bake_stage *stage)
{
    for (int s = 0; s < plan->stage_count; s++)
        if (strcmp(plan->stages[s].what.name, stage->name) == 0)
            return fail_stage(plan, stage, "its name exists twice");
    if (stage->task_count < 1 || stage->task_count > UINT32_MAX || !stage->run)
        return fail_stage(plan, stage, "it has no tasks");
    if (stage->wave < 0 || stage->wave > plan->waves || stage->wave < plan->waves - 1 ||
        stage->wave >= MAX_WAVES)
        return fail_stage(plan, stage, "its wave is neither that of the stage before nor the next");
    if (stage->part < 0 || stage->part > plan->part_count || (stage->part == 0 && plan->part_count))
        return fail_stage(plan, stage, "it is of no part");
    if (stage->output_count < 0 || stage->output_count > BAKE_MAX_OUTPUTS)
        return fail_stage(plan, stage, "it has more than 16 outputs");
    for (int i = 0; i < stage->output_count; i++)
        if (!check_output(plan, stage, &stage->outputs[i])) return false;
    return true;
}

static bool copy_outputs(struct bake_plan *plan, const struct bake_stage *stage,
                         struct planned_stage *out)
{
    const size_t count = stage->output_count > 0 ? (size_t)stage->output_count : 1;
    out->outputs = arena_alloc(&plan->arena, count, sizeof *out->outputs);
    if (!out->outputs) return false;
    for (int i = 0; i < stage->output_count; i++) {
        struct planned_output *output = &out->outputs[i];
        output->what = stage->outputs[i];
        output->what.name = arena_strdup(&plan->arena, output->what.name);
        if (!output->what.name || !tensor_extent(output->what.type, output->what.rank,
                                                 output->what.shape, &output->bytes))
            return false;
        output->view = (struct tensor){ .name = output->what.name,
                                        .type = output->what.type,
                                        .rank = output->what.rank,
                                        .bytes = output->bytes };
        memcpy(output->view.shape, output->what.shape, sizeof output->view.shape);
    }
    return true;
}

static bool grow(struct bake_plan *plan)
{
    if (plan->stage_count < plan->capacity) return true;
    const int capacity = plan->capacity ? 2 * plan->capacity : FIRST_CAPACITY;
    struct planned_stage *stages =
        host_realloc(plan->host, plan->stages, (size_t)capacity, sizeof *stages);
    if (!stages) return false;
    plan->stages = stages;
    plan->capacity = capacity;
    return true;
}

static float *alloc_unknown(struct bake_plan *plan, size_t count)
{
    float *seconds = arena_alloc(&plan->arena, count, sizeof *seconds);
    for (size_t i = 0; seconds && i < count; i++) seconds[i] = NAN;
    return seconds;
}

bool bake_plan_add(struct bake_plan *plan, const struct bake_stage *stage)
{
    if (!stage->name || !stage->name[0])
        return host_fail(plan->host, FAIL_ARGUMENT, "cannot plan a stage without a name");
    if (!check_stage(plan, stage) || !grow(plan)) return false;
    struct planned_stage planned = { .what = *stage };
    planned.what.outputs = NULL;
    planned.what.name = arena_strdup(&plan->arena, stage->name);
    planned.done = arena_alloc(&plan->arena, stage->task_count, sizeof *planned.done);
    planned.task_seconds = alloc_unknown(plan, stage->task_count);
    if (!planned.what.name || !planned.done || !planned.task_seconds ||
        !copy_outputs(plan, stage, &planned))
        return false;
    plan->stages[plan->stage_count++] = planned;
    if (stage->wave >= plan->waves) plan->waves = stage->wave + 1;
    return true;
}

struct host *bake_plan_host(const struct bake_plan *plan)
{
    return plan->host;
}

void *bake_plan_alloc(struct bake_plan *plan, size_t count, size_t size)
{
    return arena_alloc(&plan->arena, count, size);
}

char *bake_plan_name(struct bake_plan *plan, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *text = length >= 0 ? arena_alloc(&plan->arena, (size_t)length + 1, 1) : NULL;
    if (text) vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

void bake_plan_depends(struct bake_plan *plan, struct hash128 key)
{
    plan->depends_on_scene = true;
    plan->scene = key;
}

static bool grow_parts(struct bake_plan *plan)
{
    if (plan->part_count < plan->part_capacity) return true;
    const int capacity = plan->part_capacity ? 2 * plan->part_capacity : FIRST_CAPACITY;
    struct planned_part *parts =
        host_realloc(plan->host, plan->parts, (size_t)capacity, sizeof *parts);
    if (!parts) return false;
    plan->parts = parts;
    plan->part_capacity = capacity;
    return true;
}

int bake_plan_part(struct bake_plan *plan, struct hash128 key, bool *exists)
{
    *exists = true;
    for (int p = 0; p < plan->part_count; p++)
        if (hash128_same(plan->parts[p].key, key)) return p + 1;
    *exists = false;
    if (!grow_parts(plan)) return 0;
    plan->parts[plan->part_count++] = (struct planned_part){ .key = key };
    return plan->part_count;
}

bool bake_plan_part_is_loaded(const struct bake_plan *plan, int part)
{
    return part > 0 && plan->parts[part - 1].loaded;
}

void bake_plan_set_light_map(struct bake_plan *plan, struct bake_light_map map)
{
    plan->light_map = map;
}

void bake_plan_set_job(struct bake_plan *plan, const struct bake_job *job)
{
    plan->job = *job;
}
