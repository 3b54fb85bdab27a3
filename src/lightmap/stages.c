// The bake of a light map by the path tracer: one stage, whose tasks are blocks of texels.
#include "lightmap/lightmap.h"

#include "bake/scene_key.h"
#include "lightmap/gather.h"
#include "scene/statics.h"

#include <string.h>

struct job {
    struct lightmap_bake how;
    struct scene_statics statics;
    struct charts charts;
    struct gather_scene scene;
};

static bool prepare(void *argument, struct host *host)
{
    struct job *job = argument;
    return scene_statics_init(&job->statics, host, job->how.pose) &&
           job->how.charts(&job->statics.pose, job->how.options, host, &job->charts) &&
           gather_scene_init(&job->scene, host, &job->statics.pose, &job->charts);
}

static void finish(void *argument)
{
    struct job *job = argument;
    gather_scene_finish(&job->scene);
    charts_finish(&job->charts);
    scene_statics_finish(&job->statics);
}

static void gather(const struct bake_task *task, uint32_t texel, uint64_t row)
{
    const struct job *job = task->job;
    struct gather_points points;
    gather_find_points(&job->scene, texel, &points);
    if (points.count == 0) return;
    const vec3s punctual = gather_punctual(&job->scene, &points);
    const vec3s rest = gather_paths(&job->scene, &points, job->how.samples, task->bake_seed);
    float *out = bake_row(task, 1, row);
    memcpy(bake_row(task, 0, row), punctual.raw, sizeof punctual.raw);
    memcpy(out, rest.raw, sizeof rest.raw);
    out[3] = (float)points.count / GATHER_POINTS;
}

static bool run(const struct bake_task *task)
{
    const struct job *job = task->job;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    const unsigned before = embree_flush_denormals();
    bool ok = true;
    for (uint64_t i = 0; ok && i < count && first + i < job->charts.side_texel_count; i++) {
        ok = !bake_task_cancelled(task);
        if (ok) gather(task, (uint32_t)(first + i), i);
    }
    embree_restore_denormals(before);
    return ok;
}

// ---- dependencies of the light

static struct hash128 key_of(const struct scene_pose *pose)
{
    struct hash128 key = scene_key(pose, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS);
    const uint64_t environment = environment_key(&pose->scene->environment);
    key = hash128_add(key, &environment, sizeof environment);
    for (int i = 0; i < pose_light_count(pose); i++) {
        if (i < pose->scene->light_count && pose->scene->lights[i].off) continue;
        const struct world_light light = pose_light(pose, i);
        const float values[] = { light.position.x,  light.position.y,  light.position.z,
                                 light.direction.x, light.direction.y, light.direction.z,
                                 light.intensity.x, light.intensity.y, light.intensity.z,
                                 light.cos_inner,   light.cos_outer,   light.range_m };
        const int type = (int)light.type;
        key = hash128_add(hash128_add(key, &type, sizeof type), values, sizeof values);
    }
    return key;
}

// Some thousand paths, so that a task takes a fraction of a second.
enum { PATHS_PER_TASK = 16384, RAYS_PER_PATH = 8 };

static bool add_stage(struct bake_plan *plan, int samples, uint64_t rows)
{
    const uint64_t texels = rows > 0 ? rows : 1; // an empty scene has one row, of zeros
    const uint64_t tasks = (texels * (uint64_t)samples + PATHS_PER_TASK - 1) / PATHS_PER_TASK;
    const struct bake_output out[] = {
        { LIGHTMAP_PUNCTUAL, TENSOR_F32, 2, { texels, 3 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHTMAP_REST, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
    };
    const size_t count = (size_t)(tasks < texels ? tasks : texels);
    return bake_plan_add(plan, &(struct bake_stage){ .name = "paths",
                                                     .task_count = count,
                                                     .run = run,
                                                     .outputs = out,
                                                     .output_count = 2,
                                                     .rays = (double)texels * samples *
                                                             RAYS_PER_PATH / (double)count,
                                                     .texels = (double)texels / (double)count });
}

static bool count_texels(struct host *host, const struct lightmap_bake *how,
                         const struct scene_pose *statics, uint64_t *rows)
{
    struct charts charts;
    if (!how->charts(statics, how->options, host, &charts)) return false;
    *rows = charts.side_texel_count;
    charts_finish(&charts);
    return true;
}

bool lightmap_add_stages(struct bake_plan *plan, const struct lightmap_bake *how)
{
    struct host *host = bake_plan_host(plan);
    struct job *job = bake_plan_alloc(plan, 1, sizeof *job);
    struct scene_statics statics;
    uint64_t rows = 0;
    if (!job || !scene_statics_init(&statics, host, how->pose)) return false;
    job->how = *how;
    bake_plan_depends(plan, key_of(&statics.pose));
    const bool ok = count_texels(host, how, &statics.pose, &rows);
    scene_statics_finish(&statics);
    bake_plan_set_job(plan, &(struct bake_job){ .job = job, .prepare = prepare, .finish = finish });
    return ok && add_stage(plan, how->samples, rows);
}
