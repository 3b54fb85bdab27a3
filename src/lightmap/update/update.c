// The bake of an update: estimates of the change in all texels, the choice of those that are baked
// again, and their paths. Others keep the light of the earlier bake.
#include "lightmap/update/update.h"

#include "bake/scene_key.h"
#include "core/rng.h"
#include "lightmap/stages.h"

#include <string.h>

static const char FIRST_PROBES[] = "update/first", SUSPECTS[] = "update/suspects",
                  PROBES[] = "update/probes";

struct job {
    struct host *host;
    struct lightmap_bake how;
    struct scene_statics statics;
    struct charts charts;
    struct lightmap_record was, now;
    struct update_match match;
    struct update_before before;
    bool is_same; // nothing has changed
    // While tasks run.
    struct gather_scene scene, scene_before;
    struct update_coupled coupled;
    struct gather_scene probe_now, probe_before; // views with coupled lights
    bool is_in_boxes; // scenes differ in the boxes of match alone: both have the same lights
};

// ---- while tasks run

static bool prepare_before(struct job *job, struct host *host)
{
    bool ok = gather_scene_init(&job->scene_before, host, &job->before.pose, &job->charts) &&
              update_coupled_init(&job->coupled, host, job->scene_before.trace, job->scene.trace,
                                  &job->was);
    job->probe_now = job->scene;
    job->probe_now.trace = &job->coupled.now;
    job->probe_before = job->scene_before;
    job->probe_before.trace = &job->coupled.before;
    job->is_in_boxes = job->match.same_lights && !job->coupled.own_tables;
    return ok;
}

static bool prepare(void *argument, struct host *host)
{
    struct job *job = argument;
    return gather_scene_init(&job->scene, host, &job->statics.pose, &job->charts) &&
           (job->is_same || prepare_before(job, host));
}

static void finish(void *argument)
{
    struct job *job = argument;
    update_coupled_finish(&job->coupled);
    gather_scene_finish(&job->scene_before);
    gather_scene_finish(&job->scene);
}

static void destroy(void *argument)
{
    struct job *job = argument;
    update_before_finish(&job->before);
    update_match_finish(&job->match);
    lightmap_record_finish(&job->was);
    lightmap_record_finish(&job->now);
    charts_finish(&job->charts);
    scene_statics_finish(&job->statics);
}

// ---- wave 0: direct light of all texels, and estimates of the change

// Whether a texel is beside a small object that has changed, or had other points outside geometry.
static bool is_touched(const struct job *job, uint32_t texel, const struct gather_points *now)
{
    struct gather_points was;
    const enum update_near near =
        update_near_change(&job->match, chart_texel_of(&job->charts, texel)->position);
    if (near != UPDATE_NEAR) return near == UPDATE_BESIDE;
    gather_find_points(&job->scene_before, texel, &was);
    return now->count != was.count ||
           memcmp(now->at, was.at, (size_t)now->count * sizeof now->at[0]) != 0;
}

// Means of some paths of each scene, with the same random numbers. Those of now that do not meet
// the change have their equals before.
struct pair {
    vec3s before, now;
};
static struct pair trace_pair(const struct job *job, const struct gather_points *points, int first,
                              uint64_t seed)
{
    struct gather_points few = { .pixel = points->pixel, .back = points->back };
    for (; few.count < UPDATE_HALF_PATHS; few.count++)
        few.at[few.count] = points->at[(first + few.count) % points->count];
    struct ray_watch watch = { .boxes = job->match.boxes, .count = job->match.near_count };
    struct trace_scene trace = job->coupled.now;
    struct gather_scene scene = job->probe_now;
    scene.trace = &trace;
    trace.watch = job->is_in_boxes ? &watch : NULL;
    const vec3s now = gather_paths(&scene, &few, UPDATE_HALF_PATHS, seed);
    if (job->is_in_boxes && !watch.met) return (struct pair){ now, now };
    return (struct pair){ gather_paths(&job->probe_before, &few, UPDATE_HALF_PATHS, seed), now };
}

// Adds the `index`-th pair of halves, whose random numbers differ: their difference is the noise.
static void add_estimate(const struct job *job, const struct gather_points *points, int index,
                         uint64_t seed, struct update_probe *out)
{
    const int first = 2 * index * UPDATE_HALF_PATHS;
    const uint64_t half = 2 * (uint64_t)index + 1;
    const struct pair a = trace_pair(job, points, first, rng_mix(seed + half)),
                      b = trace_pair(job, points, first + UPDATE_HALF_PATHS,
                                     rng_mix(seed + half + 1));
    const float noise = luminance(a.now) - luminance(b.now), weight = 1.0f / (float)(index + 1);
    for (int c = 0; c < 3; c++) {
        const float now = 0.5f * (a.now.raw[c] + b.now.raw[c]);
        const float change = now - 0.5f * (a.before.raw[c] + b.before.raw[c]);
        out->value[c] += weight * (now - out->value[c]);
        out->change[c] += weight * (change - out->change[c]);
    }
    out->variance += weight * (0.5f * noise * noise * UPDATE_HALF_PATHS - out->variance);
}

// Points of a front whose number is that of the earlier bake are the same: if all were outside
// geometry, and no change is near, all are.
static void find_points(const struct job *job, uint32_t texel, struct gather_points *out)
{
    const bool known =
        job->match.row_was[texel] == texel && !chart_is_back(&job->charts, texel) &&
        job->was.rest[LIGHTMAP_COLUMNS * (size_t)texel + LIGHTMAP_SHARE] == 1.0f &&
        update_near_change(&job->match, job->charts.texels[texel].position) == UPDATE_FAR;
    if (known)
        gather_find_open_points(&job->scene, texel, out);
    else
        gather_find_points(&job->scene, texel, out);
}

static void probe(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    const struct job *job = user;
    struct update_probe *out = bake_row(task, 1, row);
    struct gather_points points;
    find_points(job, texel, &points);
    if (points.count > 0) {
        const vec3s punctual = gather_punctual(&job->scene, &points);
        memcpy(bake_row(task, 0, row), punctual.raw, sizeof punctual.raw);
    }
    out->touched = job->match.row_was[texel] == UPDATE_NONE;
    if (job->is_same || out->touched > 0.0f) return;
    out->touched = is_touched(job, texel, &points);
    if (out->touched > 0.0f || points.count == 0) return;
    add_estimate(job, &points, 0, task->bake_seed, out);
}

static bool run_probes(const struct bake_task *task)
{
    const struct job *job = task->job;
    return lightmap_run_rows(task, job->charts.side_texel_count, probe, (void *)job);
}

// ---- waves 1 and 2: more estimates where a few paths have changed

static bool run_suspects(const struct bake_task *task)
{
    const struct job *job = task->job;
    const struct tensor *probes = bake_task_input(task, FIRST_PROBES);
    return probes &&
           update_suspects(task->host, &job->charts, probes->data, job->how.samples, task->out[0]);
}

// Inputs of the tasks of a wave.
struct wave {
    const struct job *job;
    const struct update_probe *probes;
    const uint8_t *marks;
    struct gather_tile tile; // of the last row
};

static void probe_more(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    const struct wave *wave = user;
    struct update_probe *out = bake_row(task, 0, row);
    struct gather_points points;
    *out = wave->probes[texel];
    if (!wave->marks[texel] || out->touched > 0.0f) return;
    find_points(wave->job, texel, &points);
    for (int i = 1; points.count > 0 && i < UPDATE_PAIRS; i++)
        add_estimate(wave->job, &points, i, task->bake_seed, out);
}

static bool run_more_probes(const struct bake_task *task)
{
    const struct job *job = task->job;
    const struct tensor *first = bake_task_input(task, FIRST_PROBES),
                        *suspects = bake_task_input(task, SUSPECTS);
    if (!first || !suspects) return false;
    struct wave wave = { .job = job, .probes = first->data, .marks = suspects->data };
    return lightmap_run_rows(task, job->charts.side_texel_count, probe_more, &wave);
}

// ---- wave 3: what is baked again

static bool run_reach(const struct bake_task *task)
{
    const struct job *job = task->job;
    const struct tensor *probes = bake_task_input(task, PROBES);
    return probes &&
           update_reach(task->host, &job->charts, probes->data, job->how.samples, task->out[0]);
}

// ---- wave 4: the light of emitters, the sky and all bounces

static void gather(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    struct wave *wave = user;
    const struct job *job = wave->job;
    float *out = bake_row(task, 0, row);
    if (!wave->marks[texel]) {
        memcpy(out, job->was.rest + LIGHTMAP_COLUMNS * (size_t)job->match.row_was[texel],
               LIGHTMAP_COLUMNS * sizeof *out);
        return;
    }
    if (!gather_tile_has(&wave->tile, texel)) {
        gather_tile_of(&job->scene, texel, &wave->tile);
        gather_tile_paths(&job->scene, &wave->tile, job->how.samples, task->bake_seed);
    }
    lightmap_write_row(&wave->tile, texel, out);
}

static bool run_paths(const struct bake_task *task)
{
    const struct job *job = task->job;
    const struct tensor *again = bake_task_input(task, LIGHTMAP_AGAIN);
    struct wave wave = { .job = job, .marks = again ? again->data : NULL };
    return again && lightmap_run_rows(task, job->charts.side_texel_count, gather, &wave);
}

// ---- the plan

enum { ROWS_PER_PROBE_TASK = 256, RAYS_OF_POINTS = 100 };
enum { WAVE_FIRST, WAVE_SUSPECTS, WAVE_MORE, WAVE_REACH, WAVE_PATHS };
// The share of texels that estimates of time assume.
static const double ASSUMED_SHARE = 0.2;

static bool add_probes(struct bake_plan *plan, uint64_t rows)
{
    const size_t count = (size_t)((rows + ROWS_PER_PROBE_TASK - 1) / ROWS_PER_PROBE_TASK);
    const double rays = 4 * UPDATE_HALF_PATHS * LIGHTMAP_RAYS_PER_PATH + RAYS_OF_POINTS;
    const struct bake_output out[] = {
        { LIGHTMAP_PUNCTUAL, TENSOR_F32, 2, { rows, 3 }, BAKE_ROWS, BAKE_SAVED },
        { FIRST_PROBES, TENSOR_F32, 2, { rows, UPDATE_PROBE_FLOATS }, BAKE_ROWS, WAVE_MORE },
    };
    return bake_plan_add(plan, &(struct bake_stage){ .name = "changes",
                                                     .wave = WAVE_FIRST,
                                                     .task_count = count,
                                                     .run = run_probes,
                                                     .outputs = out,
                                                     .output_count = 2,
                                                     .rays = rays * (double)rows / (double)count,
                                                     .texels = (double)rows / (double)count });
}

static bool add_more_probes(struct bake_plan *plan, uint64_t rows)
{
    const size_t count = (size_t)((rows + ROWS_PER_PROBE_TASK - 1) / ROWS_PER_PROBE_TASK);
    const double rays =
        4 * (UPDATE_PAIRS - 1) * UPDATE_HALF_PATHS * LIGHTMAP_RAYS_PER_PATH + RAYS_OF_POINTS;
    const struct bake_output out = { PROBES,    TENSOR_F32, 2, { rows, UPDATE_PROBE_FLOATS },
                                     BAKE_ROWS, WAVE_REACH };
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "more changes",
                                    .wave = WAVE_MORE,
                                    .task_count = count,
                                    .run = run_more_probes,
                                    .outputs = &out,
                                    .output_count = 1,
                                    .rays = ASSUMED_SHARE * rays * (double)rows / (double)count });
}

// A stage of one task, which marks rows.
static bool add_marks(struct bake_plan *plan, uint64_t rows, const char *stage, int wave,
                      bool (*run)(const struct bake_task *task), const char *tensor, int keep)
{
    const struct bake_output out = { tensor, TENSOR_U8, 1, { rows }, BAKE_ROWS, keep };
    return bake_plan_add(plan, &(struct bake_stage){ .name = stage,
                                                     .wave = wave,
                                                     .task_count = 1,
                                                     .run = run,
                                                     .outputs = &out,
                                                     .output_count = 1,
                                                     .others = (double)rows,
                                                     .scratch_bytes = 16 * (size_t)rows });
}

static bool add_paths(struct bake_plan *plan, uint64_t rows, int samples)
{
    const size_t count = lightmap_task_count(rows, (uint64_t)samples);
    const double rays = (double)rows * samples * LIGHTMAP_RAYS_OF_SHARED * ASSUMED_SHARE;
    const struct bake_output out = { LIGHTMAP_REST, TENSOR_F32, 2, { rows, LIGHTMAP_COLUMNS },
                                     BAKE_ROWS,     BAKE_SAVED };
    return bake_plan_add(plan, &(struct bake_stage){ .name = "paths",
                                                     .wave = WAVE_PATHS,
                                                     .task_count = count,
                                                     .rows_together = GATHER_TILE,
                                                     .run = run_paths,
                                                     .outputs = &out,
                                                     .output_count = 1,
                                                     .rays = rays / (double)count });
}

// ---- comparison of the scenes

static struct hash128 key_of(const struct job *job)
{
    const struct lightmap_record *now = &job->now;
    struct hash128 key = hash128_add_text((struct hash128){ 0 }, "update");
    key = hash128_add(key, &job->was.content, sizeof job->was.content);
    key = hash128_add(key, &now->environment, sizeof now->environment);
    for (uint32_t i = 0; i < now->instance_count; i++) {
        key = hash128_add(key, &now->instances[i].shape, sizeof(struct hash128));
        key = hash128_add(key, &now->instances[i].surface, sizeof(struct hash128));
    }
    for (uint32_t i = 0; i < now->light_count; i++) key = scene_key_add_light(key, &now->lights[i]);
    return key;
}

static bool compare(struct job *job, const char *folder)
{
    if (!lightmap_record_init(&job->now, job->host, &job->statics.pose, &job->charts, NULL) ||
        !update_match_init(&job->match, job->host, &job->was, &job->now, &job->charts))
        return false;
    if (job->was.environment != job->now.environment)
        return host_fail(job->host, FAIL_FORMAT,
                         "cannot update %s: the sky or the environment has changed, whose light "
                         "reaches everything",
                         folder);
    if (job->match.without == job->now.row_count)
        return host_fail(job->host, FAIL_FORMAT,
                         "cannot update %s: no surface of the scene is in it", folder);
    job->is_same = job->match.changed == 0 && job->match.same_lights && job->match.without == 0;
    return job->is_same || update_before_init(&job->before, job->host, folder, &job->statics.pose,
                                              &job->was, &job->match);
}

bool lightmap_add_update_stages(struct bake_plan *plan, const struct lightmap_update *update,
                                struct lightmap_change *change)
{
    struct job *job = bake_plan_alloc(plan, 1, sizeof *job);
    if (!job) {
        lightmap_record_finish(update->was);
        charts_finish(update->charts);
        return false;
    }
    *job = (struct job){ .host = bake_plan_host(plan),
                         .how = *update->how,
                         .was = *update->was,
                         .charts = *update->charts };
    *update->was = (struct lightmap_record){ 0 };
    *update->charts = (struct charts){ 0 };
    // The scene as it was has rays of its own, and both have a record.
    const size_t record = job->charts.side_texel_count * LIGHTMAP_COLUMNS * sizeof(float);
    bake_plan_set_job(
        plan, &(struct bake_job){
                  .job = job,
                  .prepare = prepare,
                  .finish = finish,
                  .destroy = destroy,
                  .bytes = 2 * (lightmap_job_bytes(&job->charts) + record),
                  .files_bytes = lightmap_files_bytes(&job->charts, update->how->pose->scene) });
    if (!scene_statics_init(&job->statics, job->host, job->how.pose) ||
        !compare(job, update->folder))
        return false;
    const uint32_t rows = job->charts.side_texel_count;
    *change =
        (struct lightmap_change){ job->match.changed, !job->match.same_lights, rows, &job->charts };
    bake_plan_depends(plan, key_of(job));
    return add_probes(plan, rows) &&
           add_marks(plan, rows, "suspects", WAVE_SUSPECTS, run_suspects, SUSPECTS, WAVE_MORE) &&
           add_more_probes(plan, rows) &&
           add_marks(plan, rows, "reach", WAVE_REACH, run_reach, LIGHTMAP_AGAIN, BAKE_SAVED) &&
           add_paths(plan, rows, job->how.samples);
}
