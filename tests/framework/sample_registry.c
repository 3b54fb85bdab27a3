// The registry of a program for tests: it takes the place of techniques/registry.c, and has a
// technique that bakes in no time.
#include "techniques/registry.h"

#include "bake/scene_key.h"
#include "core/rng.h"
#include "techniques/none/none.h"

#include <string.h>
#include <time.h>

enum { COLUMNS = 16 };

struct sample_options {
    int32_t rows, wait_ms;
};
#define ROW(...) OPTION_ROW(struct sample_options, __VA_ARGS__)
static const struct option_row rows[] = {
    ROW(int32, rows, 8, 1, 100000, "", REBAKE, "number of rows")
        ROW(int32, wait_ms, 0, 0, 100000, "ms", REBAKE, "time of a task")
};

static void wait_ms(int ms)
{
    const struct timespec nap = { ms / 1000, (ms % 1000) * 1000000L };
    nanosleep(&nap, NULL);
}

// It does not poll, as a decomposition cannot.
static bool gather(const struct bake_task *task)
{
    uint64_t count, first = bake_task_rows(task, 0, &count);
    float *out = task->out[0], *row = host_alloc(task->host, COLUMNS, sizeof *row);
    if (!row) return false;
    for (uint64_t i = 0; i < count; i++) {
        struct rng rng = rng_for((uint32_t)(first + i), (uint32_t)task->bake_seed, 0);
        for (int c = 0; c < COLUMNS; c++) row[c] = rng_float(&rng);
        memcpy(out + i * COLUMNS, row, COLUMNS * sizeof *row);
    }
    host_log(task->host, LOG_DEBUG, "row %u", (unsigned)first);
    host_free(task->host, row);
    wait_ms(((const struct sample_options *)task->argument)->wait_ms);
    return true;
}

static bool add_up(const struct bake_task *task)
{
    const struct tensor *f = bake_task_input(task, "sample/F");
    float *out = task->out[0];
    for (uint64_t i = 0; f && i < f->shape[0] * COLUMNS; i++)
        out[i % COLUMNS] += ((const float *)f->data)[i];
    return f != NULL;
}

static bool sample_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    const struct sample_options *options = how->options;
    const struct bake_output f = { "sample/F", TENSOR_F32, 2, { (uint64_t)options->rows, COLUMNS },
                                   BAKE_ROWS,  1 };
    const struct bake_output sum = {
        "sample/sum", TENSOR_F32, 1, { COLUMNS }, BAKE_ROWS, BAKE_SAVED
    };
    bake_plan_depends(plan, scene_key(how->pose, SCENE_KEY_GEOMETRY));
    return bake_plan_add(plan, &(struct bake_stage){ .name = "gather",
                                                     .task_count = (size_t)options->rows,
                                                     .run = gather,
                                                     .argument = options,
                                                     .outputs = &f,
                                                     .output_count = 1,
                                                     .rays = 1000,
                                                     .texels = COLUMNS }) &&
           bake_plan_add(plan, &(struct bake_stage){ .name = "add up",
                                                     .wave = 1,
                                                     .task_count = 1,
                                                     .run = add_up,
                                                     .outputs = &sum,
                                                     .output_count = 1 });
}

static bool sample_report(struct report *report, struct bake *bake,
                          const struct technique_bake *how)
{
    report_number(report, "tensors", (double)bake_reported(bake)->count);
    report_bool(report, "full", how->full_report);
    return true;
}

static bool sample_create(void *state, const struct technique_create *how)
{
    (void)how;
    return state != NULL;
}

static bool sample_load(void *state, const struct tensors *bake)
{
    (void)state;
    return tensors_find(bake, "sample/sum") != NULL;
}

static void sample_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)state, (void)cmd, (void)view;
}

static const struct technique sample = { .name = "sample",
                                         .title = "sample",
                                         .paper = "none",
                                         .role = ROLE_SOURCE,
                                         .capabilities = NEEDS_BAKE,
                                         .bake_version = 1,
                                         .options = OPTION_TABLE(struct sample_options, rows, NULL),
                                         .state_size = sizeof(struct sample_options),
                                         .bake = sample_bake,
                                         .bake_report = sample_report,
                                         .create = sample_create,
                                         .load = sample_load,
                                         .record = sample_record };

const struct technique *const techniques[] = { &technique_none, &sample, NULL };

const struct technique_debug_view *technique_find_view(const struct technique *technique,
                                                       const char *name)
{
    (void)technique, (void)name;
    return NULL;
}
