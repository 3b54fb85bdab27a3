// Predicted times of a bake. A stage with finished tasks continues at their mean. Any other stage
// has the time per ray of the rays so far, and the time per operation of a product of matrices.
#include "bake/bake_state.h"

#include "core/linalg.h"

#include <math.h>
#include <time.h>

// Until rays have been timed: one million a second.
static const double RAY_GUESS_S = 1e-6;
static const double TASK_OVERHEAD_S = 1e-5;

static double thread_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double prediction_flop_seconds(struct host *host)
{
    enum { SIZE = 256 };
    static const double GUESS_S = 1e-9, FLOPS = 2.0 * SIZE * SIZE * SIZE;
    struct matrix_f64 a = { 0 }, b = { 0 };
    double seconds = GUESS_S;
    if (matrix_f64_init(host, &a, SIZE, SIZE) && matrix_f64_init(host, &b, SIZE, SIZE)) {
        for (size_t i = 0; i < SIZE * SIZE; i++) a.at[i] = (double)(i % 7);
        const double begun = thread_seconds();
        matrix_f64_multiply(host, 1.0, &a, NOT_TRANSPOSED, &a, TRANSPOSED, 0.0, &b);
        seconds = fmax(thread_seconds() - begun, 1e-6) / FLOPS;
    }
    matrix_f64_finish(host, &a);
    matrix_f64_finish(host, &b);
    return seconds;
}

struct prediction prediction_now(const struct bake *bake, double per_flop_s)
{
    double rays = 0.0, seconds = 0.0;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        if (stage->what.rays <= 0.0 || results_are_loaded(bake, stage)) continue;
        rays += stage->what.rays * (double)stage->done_count;
        seconds += stage->seconds;
    }
    return (struct prediction){ .per_ray_s = rays > 0.0 ? seconds / rays : RAY_GUESS_S,
                                .per_flop_s = per_flop_s };
}

static double task_seconds(const struct planned_stage *stage, const struct prediction *p)
{
    if (stage->done_count > 0) return stage->seconds / (double)stage->done_count;
    return TASK_OVERHEAD_S + (stage->what.rays + stage->what.others) * p->per_ray_s +
           stage->what.flops * p->per_flop_s;
}

static size_t missing_tasks(const struct bake *bake, const struct planned_stage *stage,
                            const struct bake_run_options *options)
{
    size_t count = 0, missing = 0;
    const size_t first = run_tasks(bake, &stage->what, options, &count);
    for (size_t i = first; i < first + count; i++) missing += !stage->done[i];
    return missing;
}

// A wave takes its work over all threads, but no less than its longest task.
double prediction_wave(const struct bake *bake, const struct prediction *p, int wave,
                       const struct bake_run_options *options, int threads)
{
    double work = 0.0, longest = 0.0;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        const size_t missing = stage->what.wave == wave ? missing_tasks(bake, stage, options) : 0;
        if (missing == 0) continue;
        const double each = task_seconds(stage, p);
        work += each * (double)missing;
        longest = fmax(longest, each);
    }
    return fmax(work / threads, longest);
}

double prediction_left(const struct bake *bake, const struct prediction *prediction,
                       const struct bake_run_options *options, int threads)
{
    double left = 0.0;
    for (int wave = bake->plan.waves_done; wave < bake->plan.waves; wave++)
        left += prediction_wave(bake, prediction, wave, options, threads);
    return left;
}
