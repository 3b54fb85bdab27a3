// The first stage: sample points of texels, their reflectance, hits of their rays, and the light
// of emissive surfaces and the sky.
#include "techniques/ort/bake/texels.h"

#include "bake/plan.h"
#include "core/rng.h"
#include "trace/texels/light.h"
#include "trace/texels/walls.h"

#include <string.h>

enum { TEXELS_PER_TASK = 128 };
enum {
    OUT_HITS,
    OUT_ALBEDO,
    OUT_SKY,
    OUT_SKY_SHARES,
    OUT_EMISSION,
    OUT_POINT,
    OUT_NORMAL,
    OUT_COUNT
};

bool ort_find_texels(struct ort_texels *out, const struct bake_task *task)
{
    const struct tensor *point = bake_task_input(task, LIGHT_MAP_POINT);
    const struct tensor *albedo = bake_task_input(task, LIGHT_MAP_ALBEDO);
    const struct tensor *hits = bake_task_input(task, ORT_HITS);
    if (!point || !albedo || !hits) return false;
    *out = (struct ort_texels){ task->job, point->data, albedo->data, hits->data };
    return true;
}

struct ort_texel ort_texel_of(const struct ort_texels *t, uint32_t texel)
{
    const struct charts *charts = &t->scene->map.charts;
    const struct chart_triangle *of = chart_triangle_of(charts, texel);
    const struct trace_mesh *mesh = trace_mesh_of(t->scene->trace, of->instance);
    const float *point = t->point + 4 * (size_t)texel, *albedo = t->albedo + 4 * (size_t)texel;
    return (struct ort_texel){ .position = vec3_of(point[0], point[1], point[2]),
                               .normal = chart_texel_normal(charts, texel),
                               .reach = mesh->facets[of->triangle].reach,
                               .area = ort_texel_area(t, texel),
                               .reflectance = { albedo[0], albedo[1], albedo[2] },
                               .diffuse = 0.5f + 0.5f * albedo[3] };
}

// ---- rays

struct visit {
    const struct ort_scene *scene;
    uint32_t *hits;
    uint32_t count;
};

// Rays that meet no texel leave no entry: those that do come first.
static void add_hit(void *user, const struct ray *ray, const struct ray_hit *hit, vec3s local,
                    const struct texel_hit *at_hit)
{
    struct visit *v = user;
    const int instance = v->scene->trace->meshes[hit->geometry].instance;
    const uint32_t texel = chart_texel_at(&v->scene->map.charts, instance, hit->triangle, hit->u,
                                          hit->v, at_hit->back);
    const vec3s at = glms_vec3_muladds(ray->direction, hit->distance, ray->origin);
    (void)local;
    if (!at_hit->inside && texel != CHART_NONE)
        v->hits[v->count++] = texel_before_wall(v->scene->trace, &v->scene->map.charts, texel, at);
}

static void gather(const struct bake_task *task, uint32_t texel, vec3s position, uint64_t row)
{
    const struct ort_scene *scene = task->job;
    const struct charts *charts = &scene->map.charts;
    const struct chart_triangle *of = chart_triangle_of(charts, texel);
    const vec3s normal = chart_texel_normal(charts, texel);
    const int rays = scene->options.rays;
    const float reach = trace_mesh_of(scene->trace, of->instance)->facets[of->triangle].reach;
    const struct texel_receiver receiver = {
        .position = glms_vec3_muladds(normal, reach, position),
        .normal = normal,
        .rays = rays,
        .light_samples = texel_light_samples(scene->trace, rays),
        .seed = (uint32_t)rng_mix(task->bake_seed ^ (uint64_t)texel << 32) | 1u,
        .emission = &scene->statics.emission,
    };
    struct texel_lights light;
    texel_gather_light(scene->trace, &receiver, add_hit,
                       &(struct visit){ scene, bake_row(task, OUT_HITS, row), 0 }, &light);
    memcpy(bake_row(task, OUT_SKY, row), &light.sky, sizeof light.sky);
    texel_sky_shares(&light, bake_row(task, OUT_SKY_SHARES, row));
    memcpy(bake_row(task, OUT_EMISSION, row), light.columns,
           (size_t)scene->statics.emission.count * sizeof *light.columns);
}

static void make_texel(const struct bake_task *task, uint32_t texel, uint64_t row)
{
    const struct ort_scene *scene = task->job;
    const struct charts *charts = &scene->map.charts;
    const struct texel_point point = texel_find_point(scene->trace, charts, texel);
    memset(bake_row(task, OUT_HITS, row), 0xff, (size_t)scene->options.rays * sizeof(uint32_t));
    memcpy(bake_row(task, OUT_POINT, row), &point, sizeof point);
    if (point.share == 0.0f) return;
    gather(task, texel, point.position, row);
    vec3s shading;
    const vec4s albedo = texel_reflectance(scene->trace, charts, texel, &shading);
    memcpy(bake_row(task, OUT_ALBEDO, row), albedo.raw, sizeof albedo.raw);
    memcpy(bake_row(task, OUT_NORMAL, row), shading.raw, sizeof shading.raw);
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    uint64_t count, first = bake_task_rows(task, OUT_HITS, &count);
    if (scene->map.texel_count == 0) return true;
    for (uint64_t i = 0; i < count; i++) {
        if (bake_task_cancelled(task)) return false;
        make_texel(task, (uint32_t)(first + i), i);
    }
    return true;
}

bool ort_add_texels(struct bake_plan *plan, const struct ort_scene *scene)
{
    enum { LAST_WAVE = 4 }; // maps
    const uint64_t texels = light_map_rows(scene->map.texel_count);
    const uint64_t rays = (uint64_t)scene->options.rays;
    const size_t tasks = (size_t)((texels + TEXELS_PER_TASK - 1) / TEXELS_PER_TASK);
    const struct bake_output out[OUT_COUNT] = {
        { ORT_HITS, TENSOR_U32, 2, { texels, rays }, BAKE_ROWS, LAST_WAVE },
        { LIGHT_MAP_ALBEDO, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SKY, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SKY_SHARES,
          TENSOR_U8,
          2,
          { texels, ENVIRONMENT_PATCHES },
          BAKE_ROWS,
          BAKE_SAVED },
        { LIGHT_MAP_EMISSION, TENSOR_F32, 3, { texels, scene->columns, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_POINT, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { ORT_NORMALS, TENSOR_F32, 2, { texels, 3 }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(plan,
                         &(struct bake_stage){ .name = "texels",
                                               .wave = 0,
                                               .task_count = tasks,
                                               .run = run,
                                               .outputs = out,
                                               .output_count = OUT_COUNT,
                                               .rays = (double)(texels * rays) / (double)tasks,
                                               .texels = (double)texels / (double)tasks });
}
