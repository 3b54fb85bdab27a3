// Waves of paths. The first has few for each texel. Each later one estimates the noise of all units
// of texels and adds the paths that a unit lacks, at most GROWTH times those it has: an estimate by
// few paths is rough.
#include "lightmap/adaptive.h"

#include <math.h>
#include <string.h>

enum {
    FIRST_PATHS = LIGHTMAP_LEAST_PATHS,
    GROWTH = 8,
    MORE_WAVES = 4,
    COLUMNS = sizeof(struct noise_sums) / 4
};
// Light of a unit that its noise counts against, over the mean of all.
static const float LEAST_LIGHT = 0.01f;
// A bound is met within this: one path more would not be worth a wave.
static const float NEARLY = 1.02f;

struct wave {
    int number;
    char *sums, *counts;     // names of its outputs; counts: of the plan before it
    const char *sums_before; // NULL in the first
};

// Inputs of the tasks of a wave; NULL in the first.
struct inputs {
    const struct lightmap_job *job;
    const struct noise_sums *sums; // of the wave before
    const uint32_t *counts;        // of the units
    const float *shares;
    // The texels of the last row's tile, and sums of their paths.
    struct gather_tile tile;
    struct noise_sums of_tile[GATHER_TILE];
};

static const char SHARES[] = "texels/shares";

// ---- paths

static void gather_first(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    struct inputs *in = user;
    if (!gather_tile_has(&in->tile, texel)) {
        memset(in->of_tile, 0, sizeof in->of_tile);
        gather_tile_of(&in->job->scene, texel, &in->tile);
        gather_grouped_paths(&in->job->scene, &in->tile, 0, FIRST_PATHS, task->bake_seed,
                             in->of_tile);
    }
    const uint32_t i = texel - in->tile.first;
    const vec3s punctual = gather_punctual(&in->job->scene, &in->tile.points[i]);
    memcpy(bake_row(task, 0, row), &in->of_tile[i], sizeof in->of_tile[i]);
    memcpy(bake_row(task, 1, row), punctual.raw, sizeof punctual.raw);
    *(float *)bake_row(task, 2, row) = (float)in->tile.points[i].count / GATHER_POINTS;
}

// A unit has whole charts' sides, and so whole tiles.
static void gather_more(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    struct inputs *in = user;
    struct noise_sums *sums = bake_row(task, 0, row);
    *sums = in->sums[texel];
    const uint32_t before = (uint32_t)sums->paths,
                   after = in->counts[noise_unit_of(&in->job->units, texel)];
    if (before == 0 || after <= before) return;
    if (!gather_tile_has(&in->tile, texel)) {
        gather_tile_of(&in->job->scene, texel, &in->tile);
        memcpy(in->of_tile, &in->sums[in->tile.first], in->tile.count * sizeof in->of_tile[0]);
        gather_grouped_paths(&in->job->scene, &in->tile, before, after, task->bake_seed,
                             in->of_tile);
    }
    *sums = in->of_tile[texel - in->tile.first];
}

static bool run_paths(const struct bake_task *task)
{
    const struct wave *wave = task->argument;
    const struct lightmap_job *job = task->job;
    struct inputs in = { .job = job };
    const uint32_t texels = job->charts.side_texel_count;
    if (!wave->sums_before) return lightmap_run_rows(task, texels, gather_first, &in);
    const struct tensor *sums = bake_task_input(task, wave->sums_before),
                        *counts = bake_task_input(task, wave->counts);
    if (!sums || !counts) return false;
    in.sums = sums->data;
    in.counts = counts->data;
    return lightmap_run_rows(task, texels, gather_more, &in);
}

// ---- numbers of paths

static bool run_counts(const struct bake_task *task)
{
    const struct wave *wave = task->argument;
    const struct lightmap_job *job = task->job;
    const struct tensor *input = bake_task_input(task, wave->sums_before);
    if (!input) return false;
    const struct noise_sums *sums = input->data;
    uint32_t *counts = bake_row(task, 0, 0);
    const float bound = job->how.noise;
    const float least = LEAST_LIGHT * noise_mean_light(&job->units, sums);
    const float typical = noise_typical(&job->units, sums, least, (float *)(void *)counts);
    for (uint32_t u = 0; u < job->units.count; u++) {
        const struct noise_unit *unit = &job->units.at[u];
        const struct noise_state state =
            noise_with_prior(unit, noise_of(unit, sums, least), typical);
        const uint64_t most = (uint64_t)state.paths * GROWTH,
                       limit = (uint64_t)job->how.samples / NOISE_GROUPS * NOISE_GROUPS;
        counts[u] = state.noise <= NEARLY * bound
                        ? (uint32_t)state.paths
                        : noise_paths_for(state, bound, (uint32_t)(most < limit ? most : limit));
    }
    return true;
}

// ---- results

static void take_mean(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    const struct inputs *in = user;
    const struct noise_sums *sums = &in->sums[texel];
    float *out = bake_row(task, 0, row);
    out[LIGHTMAP_SHARE] = in->shares[texel];
    if (!(sums->paths > 0.0f)) return;
    for (int c = 0; c < 3; c++) out[c] = sums->light[c] / sums->paths;
    out[LIGHTMAP_VARIANCE] = (float)noise_variance(sums);
}

static bool run_means(const struct bake_task *task)
{
    const struct wave *wave = task->argument;
    const struct lightmap_job *job = task->job;
    const struct tensor *sums = bake_task_input(task, wave->sums_before),
                        *shares = bake_task_input(task, SHARES);
    if (!sums || !shares) return false;
    struct inputs in = { .job = job, .sums = sums->data, .shares = shares->data };
    return lightmap_run_rows(task, job->charts.side_texel_count, take_mean, &in);
}

static bool run_noise(const struct bake_task *task)
{
    const struct wave *wave = task->argument;
    const struct lightmap_job *job = task->job;
    const struct tensor *input = bake_task_input(task, wave->sums_before);
    if (!input) return false;
    const float least = LEAST_LIGHT * noise_mean_light(&job->units, input->data);
    for (uint32_t u = 0; u < job->units.count; u++) {
        const struct noise_unit *unit = &job->units.at[u];
        const struct noise_state state = noise_of(unit, input->data, least);
        const float row[] = { state.noise, state.paths, (float)unit->count };
        memcpy(bake_row(task, 0, u), row, sizeof row);
    }
    return true;
}

// ---- stages

static struct wave *name_wave(struct bake_plan *plan, int number, const struct wave *before)
{
    struct wave *wave = bake_plan_alloc(plan, 1, sizeof *wave);
    if (!wave) return NULL;
    *wave = (struct wave){ .number = number,
                           .sums = bake_plan_name(plan, "texels/sums/%d", number),
                           .counts = bake_plan_name(plan, "charts/paths/%d", number),
                           .sums_before = before ? before->sums : NULL };
    return wave->sums && wave->counts ? wave : NULL;
}

// Paths of a texel in a wave that estimates of the time assume: most charts need some hundred.
static uint64_t expected_paths(int number)
{
    static const uint64_t expected[MORE_WAVES + 1] = { FIRST_PATHS, 64, 64, 32, 16 };
    return expected[number];
}

static bool add_paths(struct bake_plan *plan, const struct wave *wave, uint64_t texels)
{
    const uint64_t paths = expected_paths(wave->number);
    const size_t tasks = lightmap_task_count(texels, paths);
    const int at = 2 * wave->number;
    const struct bake_output out[] = {
        BAKE_F32(BAKE_ROWS, wave->sums, at + 2, texels, COLUMNS),
        BAKE_F32(BAKE_ROWS, LIGHTMAP_PUNCTUAL, BAKE_SAVED, texels, 3),
        BAKE_F32(BAKE_ROWS, SHARES, 2 * MORE_WAVES + 1, texels, 1),
    };
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = bake_plan_name(plan, "paths %d", wave->number + 1),
                  .wave = at,
                  .task_count = tasks,
                  .rows_together = GATHER_TILE,
                  .run = run_paths,
                  .argument = wave,
                  .outputs = out,
                  .output_count = wave->sums_before ? 1 : 3,
                  .rays = (double)(texels * paths * LIGHTMAP_RAYS_OF_SHARED) / (double)tasks,
                  .texels = wave->sums_before ? 0.0 : (double)texels / (double)tasks });
}

static bool add_counts(struct bake_plan *plan, const struct wave *wave, uint64_t units)
{
    const struct bake_output out = { wave->counts, TENSOR_U32, 1,
                                     { units },    BAKE_ROWS,  2 * wave->number };
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = bake_plan_name(plan, "noise %d", wave->number),
                                    .wave = 2 * wave->number - 1,
                                    .task_count = 1,
                                    .run = run_counts,
                                    .argument = wave,
                                    .outputs = &out,
                                    .output_count = 1 });
}

static bool add_results(struct bake_plan *plan, const struct wave *last, uint64_t texels,
                        uint64_t units)
{
    const int at = 2 * MORE_WAVES + 1;
    const struct bake_stage means = { .name = "means",
                                      .wave = at,
                                      .task_count = 1,
                                      .run = run_means,
                                      .argument = last,
                                      BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, LIGHTMAP_REST, BAKE_SAVED,
                                                            texels, LIGHTMAP_COLUMNS)) };
    const struct bake_stage noise = { .name = "noise",
                                      .wave = at,
                                      .task_count = 1,
                                      .run = run_noise,
                                      .argument = last,
                                      BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, LIGHTMAP_NOISE, BAKE_SAVED,
                                                            units, 3)) };
    return bake_plan_add(plan, &means) && bake_plan_add(plan, &noise);
}

bool adaptive_add_stages(struct bake_plan *plan, const struct lightmap_job *job)
{
    const uint64_t texels = job->charts.side_texel_count > 0 ? job->charts.side_texel_count : 1;
    const uint64_t units = job->units.count > 0 ? job->units.count : 1;
    const struct wave *wave = NULL;
    for (int number = 0; number <= MORE_WAVES; number++) {
        const struct wave *next = name_wave(plan, number, wave);
        if (!next || (wave && !add_counts(plan, next, units)) || !add_paths(plan, next, texels))
            return false;
        wave = next;
    }
    const struct wave *results = name_wave(plan, MORE_WAVES + 1, wave);
    return results && add_results(plan, results, texels, units);
}

// ---- the result of a bake

static bool read_units(const struct lightmap *map, const struct tensors *bake, float bound,
                       uint64_t units, struct lightmap_noise *out)
{
    const float *rows = tensors_expect(map->host, bake, LIGHTMAP_NOISE, TENSOR_F32, 2,
                                       (const uint64_t[]){ units, 3 });
    double paths = 0.0, texels = 0.0;
    out->largest = 0.0f;
    for (uint64_t u = 0; rows && u < units; u++) {
        const float *row = rows + 3 * u;
        out->largest = fmaxf(out->largest, row[0]);
        out->units++;
        out->above += row[0] > NEARLY * bound;
        out->quiet += row[0] < 0.5f * bound;
        paths += (double)row[1] * (double)row[2];
        texels += (double)row[2];
    }
    out->paths = texels > 0.0 ? (float)(paths / texels) : 0.0f;
    return rows;
}

bool lightmap_noise_read(const struct lightmap *map, const struct tensors *bake, int samples,
                         float bound, struct lightmap_noise *out)
{
    *out = (struct lightmap_noise){ .paths = (float)samples, .largest = NAN };
    if (!(bound > 0.0f)) return true;
    struct noise_units units;
    const bool ok = noise_units_init(&units, &map->charts) &&
                    read_units(map, bake, bound, units.count > 0 ? units.count : 1, out);
    noise_units_finish(&units, map->host);
    return ok;
}
