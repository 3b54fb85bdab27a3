// The tensors of a plan: memory for the blocks of tasks, sums in a fixed order, lifetime.
#include "bake/bake_state.h"

#include <assert.h>
#include <string.h>

uint64_t output_rows(const struct bake_output *output)
{
    return output->rank > 0 ? output->shape[0] : 1;
}

char *output_block(const struct planned_stage *stage, const struct planned_output *output,
                   size_t task, size_t *bytes)
{
    if (output->what.reduction == BAKE_SUM) {
        *bytes = output->bytes;
        return output->parts ? output->parts + task * output->bytes : NULL;
    }
    const uint64_t total = output_rows(&output->what);
    uint64_t rows = 0;
    const uint64_t first =
        bake_rows_together(total, stage->what.rows_together, task, stage->what.task_count, &rows);
    const size_t row_bytes = total > 0 ? output->bytes / (size_t)total : 0;
    *bytes = (size_t)rows * row_bytes;
    return output->data ? output->data + (size_t)first * row_bytes : NULL;
}

size_t output_block_sizes(const struct planned_stage *stage, size_t task, size_t *bytes)
{
    size_t sum = 0;
    for (int i = 0; i < stage->what.output_count; i++) {
        output_block(stage, &stage->outputs[i], task, &bytes[i]);
        sum += bytes[i];
    }
    return sum;
}

static bool begin_output(struct bake *bake, const struct planned_stage *stage,
                         struct planned_output *output)
{
    if (output->data || output->parts) return true;
    char *memory = NULL;
    if (output->what.reduction == BAKE_SUM)
        memory = output->parts = host_alloc(bake->host, stage->what.task_count, output->bytes);
    else
        memory = output->data = host_alloc(bake->host, output->bytes, 1);
    return memory != NULL;
}

bool results_begin(struct bake *bake, int wave)
{
    for (int s = 0; s < bake->plan.stage_count; s++) {
        struct planned_stage *stage = &bake->plan.stages[s];
        if (stage->what.wave != wave || results_are_loaded(bake, stage)) continue;
        for (int i = 0; i < stage->what.output_count; i++)
            if (!begin_output(bake, stage, &stage->outputs[i])) return false;
    }
    return true;
}

// The sum in place of the first task's part, in the order of the tasks.
static void add_parts(struct planned_output *output, size_t task_count)
{
    const size_t count = output->bytes / sizeof(float);
    float *sum = (float *)(void *)output->parts;
    for (size_t task = 1; task < task_count; task++) {
        const float *part = sum + task * count;
        for (size_t i = 0; i < count; i++) sum[i] += part[i];
    }
}

static bool reduce_output(struct bake *bake, const struct planned_stage *stage,
                          struct planned_output *output)
{
    if (output->what.reduction != BAKE_SUM || results_are_loaded(bake, stage)) return true;
    if (!output->data) {
        output->data = host_alloc(bake->host, output->bytes, 1);
        if (!output->data) return false;
        add_parts(output, stage->what.task_count);
        memcpy(output->data, output->parts, output->bytes);
    }
    host_free(bake->host, output->parts);
    output->parts = NULL;
    return true;
}

bool results_reduce(struct bake *bake, int wave)
{
    for (int s = 0; s < bake->plan.stage_count; s++) {
        struct planned_stage *stage = &bake->plan.stages[s];
        for (int i = 0; i < stage->what.output_count; i++) {
            struct planned_output *output = &stage->outputs[i];
            if (stage->what.wave == wave) {
                if (!reduce_output(bake, stage, output)) return false;
                output->view.data = output->data;
            }
            if (output->what.keep > wave) continue;
            host_free(bake->host, output->data);
            output->view.data = output->data = NULL;
        }
    }
    return true;
}

bool results_wave_is_done(const struct bake *bake, int wave)
{
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        if (stage->what.wave == wave && stage->done_count < stage->what.task_count) return false;
    }
    return true;
}

bool results_are_loaded(const struct bake *bake, const struct planned_stage *stage)
{
    return bake_plan_part_is_loaded(&bake->plan, stage->what.part);
}

bool results_complete_waves(struct bake *bake)
{
    struct bake_plan *plan = &bake->plan;
    for (int wave = plan->waves_done; wave < plan->waves; wave++) {
        if (!results_wave_is_done(bake, wave)) return true;
        if (!results_reduce(bake, wave)) return false;
        plan->waves_done = wave + 1;
    }
    return bake->tensors || results_collect(bake);
}

void results_free(struct bake *bake)
{
    for (int s = 0; s < bake->plan.stage_count; s++)
        for (int i = 0; i < bake->plan.stages[s].what.output_count; i++) {
            struct planned_output *output = &bake->plan.stages[s].outputs[i];
            host_free(bake->host, output->data);
            host_free(bake->host, output->parts);
            output->data = output->parts = NULL;
        }
    host_free(bake->host, bake->tensors);
    bake->tensors = NULL;
}

static size_t collect(struct bake *bake, int keep, struct tensor *out)
{
    size_t count = 0;
    for (int s = 0; s < bake->plan.stage_count; s++)
        for (int i = 0; i < bake->plan.stages[s].what.output_count; i++) {
            const struct planned_output *output = &bake->plan.stages[s].outputs[i];
            if (output->what.keep != keep) continue;
            if (out) out[count] = output->view;
            count++;
        }
    return count;
}

bool results_collect(struct bake *bake)
{
    assert(!bake->tensors);
    bake->saved_count = collect(bake, BAKE_SAVED, NULL);
    bake->reported_count = collect(bake, BAKE_REPORTED, NULL);
    const size_t count = bake->saved_count + bake->reported_count;
    bake->tensors = host_alloc(bake->host, count, sizeof *bake->tensors);
    if (!bake->tensors) return false;
    collect(bake, BAKE_SAVED, bake->tensors);
    collect(bake, BAKE_REPORTED, bake->tensors + bake->saved_count);
    bake->saved = (struct tensors){ .at = bake->tensors, .count = bake->saved_count };
    bake->all = (struct tensors){ .at = bake->tensors, .count = count };
    return true;
}

const struct tensor *results_find(const struct bake *bake, const char *name)
{
    for (int s = 0; s < bake->plan.stage_count; s++)
        for (int i = 0; i < bake->plan.stages[s].what.output_count; i++) {
            const struct tensor *view = &bake->plan.stages[s].outputs[i].view;
            if (view->data && strcmp(view->name, name) == 0) return view;
        }
    return NULL;
}
