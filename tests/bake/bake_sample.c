#include "bake/bake_sample.h"

#include "core/files/file.h"
#include "core/linalg.h"
#include "core/rng.h"
#include "framework/test.h"

#include <string.h>
#include <time.h>

enum { COLUMNS = 6, ROW_TASKS = 7, SUM_TASKS = 5, SUM_SIZE = 4, MODES = 3 };

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool idle(const struct bake_task *task, double seconds)
{
    const double begun = now_s();
    const struct timespec nap = { 0, 2000000 };
    while (now_s() - begun < seconds) {
        if (bake_task_cancelled(task)) return false;
        nanosleep(&nap, NULL);
    }
    return true;
}

static struct bake_sample *sample_of(const struct bake_task *task)
{
    struct bake_sample *const *sample = task->job;
    atomic_fetch_add(&(*sample)->runs, 1);
    return *sample;
}

static bool gather(const struct bake_task *task)
{
    struct bake_sample *sample = sample_of(task);
    uint64_t count, first = bake_task_rows(task, 0, &count), other;
    float *rows = task->out[0];
    uint8_t *mask = task->out[1];
    if ((int)task->index == sample->failing_task)
        return host_fail(task->host, FAIL_UNSUPPORTED, "cannot gather row %d: it is made to fail",
                         (int)first);
    if (bake_task_rows(task, 1, &other) != first || other != count) return false;
    for (uint64_t i = 0; i < count; i++) {
        struct rng rng = rng_for((uint32_t)(first + i), (uint32_t)task->bake_seed, 0);
        for (int c = 0; c < COLUMNS; c++) rows[i * COLUMNS + (uint64_t)c] += rng_float(&rng);
        mask[i] = (uint8_t)(rng_u32(&rng) & 1);
    }
    return idle(task, sample->task_s);
}

static bool add_up(const struct bake_task *task)
{
    struct bake_sample *sample = sample_of(task);
    struct rng rng = rng_for((uint32_t)task->seed, (uint32_t)(task->seed >> 32), 1);
    float *sum = task->out[0];
    for (int i = 0; i < SUM_SIZE; i++) sum[i] += rng_float(&rng) * 1e3f;
    return idle(task, sample->task_s);
}

// The first modes of F, scaled by the sum.
static bool decompose(const struct bake_task *task)
{
    const struct tensor *f = bake_task_input(task, "sample/F");
    const struct tensor *sum = bake_task_input(task, "sample/sum");
    struct matrix_f64 a = { 0 };
    struct linalg_svd svd = { 0 };
    sample_of(task);
    if (!f || !sum) return false;
    const struct matrix_f32 rows = { (float *)f->data, f->shape[0], f->shape[1], f->shape[1] };
    const float *factor = sum->data;
    bool ok =
        matrix_f64_from_f32(task->host, &rows, &a) && linalg_svd(task->host, f->name, &a, &svd);
    for (size_t r = 0; ok && r < a.rows; r++)
        for (size_t i = 0; i < MODES; i++)
            ((float *)task->out[0])[r * MODES + i] =
                (float)svd.u.at[r * svd.u.stride + i] * factor[i];
    for (size_t i = 0; ok && i < svd.count; i++) ((float *)task->out[1])[i] = (float)svd.sigma[i];
    linalg_svd_finish(task->host, &svd);
    matrix_f64_finish(task->host, &a);
    return ok;
}

static bool round_modes(const struct bake_task *task)
{
    const struct tensor *u = bake_task_input(task, "sample/U");
    uint64_t count, first = bake_task_rows(task, 0, &count);
    const struct bake_sample *sample = sample_of(task);
    for (uint64_t i = 0; u && i < count * MODES; i++)
        ((int32_t *)task->out[0])[i] = (int32_t)((const float *)u->data)[first * MODES + i];
    return u && idle(task, sample->last_s);
}

static bool prepare(void *job, struct host *host)
{
    struct bake_sample *sample = *(struct bake_sample **)job;
    atomic_fetch_add(&sample->prepared, 1);
    nanosleep(&(struct timespec){ .tv_nsec = (long)(1e9 * sample->prepare_s) }, NULL);
    return !sample->fail_prepare || host_fail(host, FAIL_MEMORY, "cannot prepare the sample");
}

static void finish(void *job)
{
    atomic_fetch_add(&(*(struct bake_sample **)job)->finished, 1);
}

static bool add_first_wave(struct bake_plan *plan, const struct bake_sample *sample)
{
    const uint64_t rows = (uint64_t)sample->rows;
    const struct bake_output f[] = {
        { "sample/F", TENSOR_F32, 2, { rows, COLUMNS }, BAKE_ROWS, 1 },
        { "sample/mask", TENSOR_U8, 1, { rows }, BAKE_ROWS, BAKE_SAVED }
    };
    const struct bake_output sum = {
        "sample/sum", TENSOR_F32, 1, { SUM_SIZE }, BAKE_SUM, BAKE_SAVED
    };
    return bake_plan_add(plan, &(struct bake_stage){ .name = "gather",
                                                     .task_count = ROW_TASKS,
                                                     .run = gather,
                                                     .outputs = f,
                                                     .output_count = 2,
                                                     .rays = 100,
                                                     .texels = 10 }) &&
           bake_plan_add(plan, &(struct bake_stage){ .name = "add up",
                                                     .task_count = SUM_TASKS,
                                                     .run = add_up,
                                                     .outputs = &sum,
                                                     .output_count = 1,
                                                     .rays = 50,
                                                     .scratch_bytes = 1000 });
}

static bool add_other_waves(struct bake_plan *plan, const struct bake_sample *sample)
{
    const uint64_t rows = (uint64_t)sample->rows;
    const struct bake_output u[] = {
        { "sample/U", TENSOR_F32, 2, { rows, MODES }, BAKE_ROWS, BAKE_SAVED },
        { "sample/sigma", TENSOR_F32, 1, { COLUMNS }, BAKE_ROWS, BAKE_REPORTED }
    };
    const struct bake_output rounded = { "sample/rounded", TENSOR_I32, 2,
                                         { rows, MODES },  BAKE_ROWS,  BAKE_SAVED };
    return bake_plan_add(plan, &(struct bake_stage){ .name = "decompose",
                                                     .wave = 1,
                                                     .task_count = 1,
                                                     .run = decompose,
                                                     .outputs = u,
                                                     .output_count = 2,
                                                     .flops = 1e4 }) &&
           bake_plan_add(plan, &(struct bake_stage){ .name = "round",
                                                     .wave = 2,
                                                     .task_count = 4,
                                                     .run = round_modes,
                                                     .outputs = &rounded,
                                                     .output_count = 1,
                                                     .flops = sample->last_flops });
}

struct bake_sample bake_sample_default(void)
{
    return (struct bake_sample){ .rows = 23, .last_flops = 1e6, .failing_task = -1 };
}

struct bake_identity bake_sample_identity(void)
{
    return (struct bake_identity){ .technique = "sample",
                                   .version = 3,
                                   .options = "rows=23,modes=3",
                                   .seed = 5,
                                   .program = "1.2.3",
                                   .gi = "sample:rows=23",
                                   .scene_name = "@sample" };
}

struct bake *bake_sample_create(struct bake_sample *sample, const struct bake_identity *identity)
{
    struct bake *bake = bake_sample_create_for(test_host(), sample, identity);
    CHECK(bake != NULL);
    return bake;
}

struct bake *bake_sample_create_for(struct host *host, struct bake_sample *sample,
                                    const struct bake_identity *identity)
{
    const struct bake_identity fallback = bake_sample_identity();
    struct bake *bake = bake_create(host, identity ? identity : &fallback);
    if (!bake) return NULL;
    struct bake_plan *plan = bake_plan_of(bake);
    struct bake_sample **job = bake_plan_alloc(plan, 1, sizeof *job);
    if (!job) return NULL;
    *job = sample;
    bake_plan_set_job(plan, &(struct bake_job){
                                .job = job, .prepare = prepare, .finish = finish, .bytes = 10000 });
    bake_plan_depends(plan, hash128_add_text((struct hash128){ 0 }, "scene"));
    return add_first_wave(plan, sample) && add_other_waves(plan, sample) ? bake : NULL;
}

struct file_bytes bake_sample_bytes(const char *path)
{
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 0, &bytes));
    return bytes;
}
