// Tasks that a run with shards covers. Shards split one wave between them: the first, or after a
// merge of parts the next one of enough work. Waves before it run in each shard, whole.
#include "bake/bake_state.h"

// A wave is split from this share of the plan's cost on. Below it, a round of files costs more than
// to run the wave in each shard.
static const double SPLIT_SHARE = 0.02;

// Floating-point operations of dense linear algebra that take as long as a ray, roughly. Not
// measured: all shards must split the same wave.
static const double FLOPS_PER_RAY = 5e4;

static double cost_of(const struct bake_stage *stage)
{
    return (stage->rays + stage->others + stage->flops / FLOPS_PER_RAY) * (double)stage->task_count;
}

static double cost_of_wave(const struct bake_plan *plan, int wave)
{
    double cost = 0.0;
    for (int s = 0; s < plan->stage_count; s++)
        if (plan->stages[s].what.wave == wave) cost += cost_of(&plan->stages[s].what);
    return cost;
}

int split_wave(const struct bake *bake)
{
    const struct bake_plan *plan = &bake->plan;
    double all = 0.0;
    for (int s = 0; s < plan->stage_count; s++) all += cost_of(&plan->stages[s].what);
    int wave = bake->merged.waves;
    while (wave > 0 && wave < plan->waves && !(cost_of_wave(plan, wave) >= SPLIT_SHARE * all))
        wave++;
    return wave;
}

const char *bake_split_stage(const struct bake *bake)
{
    const struct bake_plan *plan = &bake->plan;
    const int wave = split_wave(bake);
    const struct planned_stage *most = NULL;
    for (int s = 0; s < plan->stage_count; s++) {
        const struct planned_stage *stage = &plan->stages[s];
        if (stage->what.wave == wave && (!most || cost_of(&stage->what) > cost_of(&most->what)))
            most = stage;
    }
    return most ? most->what.name : NULL;
}

size_t run_tasks(const struct bake *bake, const struct bake_stage *stage,
                 const struct bake_run_options *options, size_t *count)
{
    const int split = options->shard_count > 0 ? split_wave(bake) : bake->plan.waves;
    uint64_t part = stage->task_count, first = 0;
    if (stage->wave == split)
        first = bake_rows(stage->task_count, (size_t)options->shard, (size_t)options->shard_count,
                          &part);
    *count = stage->wave > split ? 0 : (size_t)part;
    return (size_t)first;
}
