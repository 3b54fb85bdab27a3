// The estimate of a bake: rays, bytes, memory, and time by a probe run.
#include "bake/bake_state.h"

#include "core/parallel.h"

#include <math.h>
#include <string.h>

static const uint64_t HEADER_BYTES = 1024, TENSOR_HEADER_BYTES = 128;

static uint64_t output_memory(const struct planned_stage *stage,
                              const struct planned_output *output, int wave)
{
    if (stage->what.wave > wave || output->what.keep < wave) return 0;
    const bool summing = output->what.reduction == BAKE_SUM && stage->what.wave == wave;
    return (uint64_t)output->bytes * (summing ? stage->what.task_count + 1 : 1);
}

static uint64_t wave_memory(const struct bake *bake, int wave, int threads)
{
    uint64_t bytes = 0;
    size_t scratch = 0;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        for (int i = 0; i < stage->what.output_count; i++)
            bytes += output_memory(stage, &stage->outputs[i], wave);
        if (stage->what.wave == wave && stage->what.scratch_bytes > scratch)
            scratch = stage->what.scratch_bytes;
    }
    return bytes + (uint64_t)threads * scratch;
}

static uint64_t result_memory(const struct bake *bake)
{
    uint64_t bytes = 0;
    for (int s = 0; s < bake->plan.stage_count; s++)
        for (int i = 0; i < bake->plan.stages[s].what.output_count; i++)
            if (bake->plan.stages[s].outputs[i].what.keep == BAKE_SAVED)
                bytes += bake->plan.stages[s].outputs[i].bytes;
    return bytes;
}

uint64_t estimate_peak_memory(const struct bake *bake, int threads)
{
    const uint64_t files = result_memory(bake) + bake->plan.job.files_bytes;
    uint64_t peak = 0;
    if (threads <= 0) threads = parallel_threads();
    for (int wave = 0; wave < bake->plan.waves; wave++) {
        const uint64_t bytes = wave_memory(bake, wave, threads);
        if (bytes > peak) peak = bytes;
    }
    peak += bake->plan.job.bytes;
    return peak > files ? peak : files;
}

static void add_stages(const struct bake *bake, const struct bake_run_options *options,
                       struct bake_estimate *out)
{
    out->file_bytes = HEADER_BYTES;
    for (int s = 0; s < bake->plan.stage_count; s++) {
        const struct planned_stage *stage = &bake->plan.stages[s];
        size_t tasks = 0;
        run_tasks(bake, &stage->what, options, &tasks);
        if (results_are_loaded(bake, stage)) tasks = 0;
        out->rays += stage->what.rays * (double)tasks;
        out->texels += stage->what.texels * (double)tasks;
        for (int i = 0; i < stage->what.output_count; i++)
            if (stage->outputs[i].what.keep == BAKE_SAVED)
                out->file_bytes += stage->outputs[i].bytes + TENSOR_HEADER_BYTES;
    }
}

bool bake_estimate(struct bake *bake, const struct bake_run_options *options, bool probe,
                   struct bake_estimate *out)
{
    const int threads = options->threads > 0 ? options->threads : parallel_threads();
    const struct bake_run_options few = { .threads = threads };
    *out = (struct bake_estimate){ .seconds = (double)NAN, .light_map = bake->plan.light_map };
    add_stages(bake, options, out);
    out->peak_memory_bytes = estimate_peak_memory(bake, threads);
    if (!probe) return true;
    if (!bake_is_complete(bake) && !bake_resume(bake, options->checkpoint)) return false;
    if (!bake_is_complete(bake) && !run_bake(bake, &few, true)) return false;
    const struct prediction speed = prediction_now(bake, prediction_flop_seconds(bake->host));
    const int useful = threads < parallel_threads() ? threads : parallel_threads();
    // The run prepares its job again, as the probe has.
    out->seconds = bake_is_complete(bake)
                       ? 0.0
                       : bake->prepare_seconds + prediction_left(bake, &speed, options, useful);
    return true;
}
