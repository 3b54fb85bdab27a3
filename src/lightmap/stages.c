// The bake of a light map by the path tracer: one stage, whose tasks are blocks of texels.
#include "lightmap/adaptive.h"

#include "bake/scene_key.h"

#include <string.h>
#include <sys/stat.h>

static bool prepare(void *argument, struct host *host)
{
    struct lightmap_job *job = argument;
    return scene_statics_init(&job->statics, host, job->how.pose) &&
           gather_scene_init(&job->scene, host, &job->statics.pose, &job->charts);
}

static void finish(void *argument)
{
    struct lightmap_job *job = argument;
    gather_scene_finish(&job->scene);
    scene_statics_finish(&job->statics);
}

static void destroy(void *argument)
{
    struct lightmap_job *job = argument;
    noise_units_finish(&job->units, job->host);
    charts_finish(&job->charts);
}

static size_t charts_bytes(const struct charts *charts)
{
    return charts->triangle_count * sizeof *charts->triangles +
           (size_t)charts->width * charts->height * sizeof *charts->owner +
           charts->texel_count * sizeof *charts->texels;
}

// About two triangles meet a texel.
static size_t rays_bytes(const struct charts *charts)
{
    enum { OF_LISTS = 12 };
    return charts->triangle_count * (size_t)TRACE_TRIANGLE_BYTES + charts->texel_count * OF_LISTS;
}

size_t lightmap_job_bytes(const struct charts *charts)
{
    return charts_bytes(charts) + rays_bytes(charts);
}

// Bytes of the file and of its copy; of a built-in scene its data.
static size_t copy_bytes(const struct scene *scene)
{
    struct stat file;
    return stat(scene->name, &file) == 0 && S_ISREG(file.st_mode) ? 2 * (size_t)file.st_size
                                                                  : scene_memory_bytes(scene);
}

// The map has charts of its own. Rays measure the map before its files are written.
size_t lightmap_files_bytes(const struct charts *charts, const struct scene *scene)
{
    enum { OF_MEASURES = 96 }; // of a texel: seams, quality, images of the report
    const bool has_back = charts->side_texel_count > charts->texel_count;
    const size_t image = (size_t)charts->width * charts->height * 3 * sizeof(float);
    const size_t rows = charts->side_texel_count * (sizeof(struct lightmap_texel) +
                                                    LIGHTMAP_COLUMNS * sizeof(float) + OF_MEASURES);
    const size_t rays = rays_bytes(charts), copy = copy_bytes(scene);
    return 2 * charts_bytes(charts) + image * (has_back ? 2 : 1) + rows +
           (rays > copy ? rays : copy);
}

// ---- one number of paths for all texels

// A task: texels of a tile follow each other, and their light is gathered at once.
struct gathering {
    const struct lightmap_job *job;
    struct gather_tile tile;
};

static void gather(void *user, const struct bake_task *task, uint32_t texel, uint64_t row)
{
    struct gathering *g = user;
    const struct gather_scene *scene = &g->job->scene;
    if (!gather_tile_has(&g->tile, texel)) {
        gather_tile_of(scene, texel, &g->tile);
        gather_tile_paths(scene, &g->tile, g->job->how.samples, task->bake_seed);
    }
    const struct gather_points *points = &g->tile.points[texel - g->tile.first];
    if (points->count == 0) return;
    const vec3s punctual = gather_punctual(scene, points);
    memcpy(bake_row(task, 0, row), punctual.raw, sizeof punctual.raw);
    lightmap_write_row(&g->tile, texel, bake_row(task, 1, row));
}

static bool run(const struct bake_task *task)
{
    struct gathering g = { .job = task->job };
    return lightmap_run_rows(task, g.job->charts.side_texel_count, gather, &g);
}

// ---- planning

static bool add_stage(struct bake_plan *plan, int samples, uint64_t texels)
{
    const size_t count = lightmap_task_count(texels, (uint64_t)samples);
    return bake_plan_add(
        plan,
        &(struct bake_stage){
            .name = "paths",
            .task_count = count,
            .rows_together = GATHER_TILE,
            .run = run,
            BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, LIGHTMAP_PUNCTUAL, BAKE_SAVED, texels, 3),
                         BAKE_F32(BAKE_ROWS, LIGHTMAP_REST, BAKE_SAVED, texels, LIGHTMAP_COLUMNS)),
            .rays = (double)texels * samples * LIGHTMAP_RAYS_OF_SHARED / (double)count,
            .texels = (double)texels / (double)count });
}

static bool plan_job(struct lightmap_job *job, struct host *host, const struct lightmap_bake *how,
                     struct bake_plan *plan)
{
    struct scene_statics statics;
    *job = (struct lightmap_job){ .host = host, .how = *how };
    if (!scene_statics_init(&statics, host, how->pose)) return false;
    bake_plan_depends(plan, scene_key_lit(&statics.pose));
    const bool ok = how->charts(&statics.pose, how->options, host, NULL, &job->charts);
    scene_statics_finish(&statics);
    return ok && (!(how->noise > 0.0f) || noise_units_init(&job->units, &job->charts));
}

bool lightmap_add_stages(struct bake_plan *plan, const struct lightmap_bake *how,
                         const struct charts **charts)
{
    struct lightmap_job *job = bake_plan_alloc(plan, 1, sizeof *job);
    if (!job) return false;
    const bool ok = plan_job(job, bake_plan_host(plan), how, plan);
    bake_plan_set_job(plan, &(struct bake_job){ .job = job,
                                                .prepare = prepare,
                                                .finish = finish,
                                                .destroy = destroy,
                                                .bytes = lightmap_job_bytes(&job->charts),
                                                .files_bytes = lightmap_files_bytes(
                                                    &job->charts, how->pose->scene) });
    if (charts) *charts = &job->charts;
    if (!ok || how->noise > 0.0f) return ok && adaptive_add_stages(plan, job);
    // An empty scene has one row, of zeros.
    return add_stage(plan, how->samples,
                     job->charts.side_texel_count > 0 ? job->charts.side_texel_count : 1);
}
