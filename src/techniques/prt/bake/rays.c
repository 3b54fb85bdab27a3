// The first stage: sample points of receivers, their reflectance, hits of their rays, the transfer
// of the visible sky (Sloan, Kautz & Snyder 2002), and light of emissive surfaces.
#include "techniques/prt/bake/scene.h"

#include "bake/plan.h"
#include "core/rng.h"
#include "trace/texels/light.h"

#include <string.h>

enum { RECEIVERS_PER_TASK = 128 };
enum { OUT_ROWS, OUT_ALBEDO, OUT_SKY, OUT_EMITTED, OUT_POINT, OUT_HITS, OUT_COUNT };

struct visit {
    const struct prt_scene *scene;
    uint32_t seed; // of the receiver
    int bands;
    float *row;     // transfer
    uint32_t *hits; // NULL: without bounces
    uint32_t count; // of hits
};

// Rays that meet no receiver leave no entry: those that do come first.
static void add_hit(void *user, const struct ray *ray, const struct ray_hit *hit, vec3s local,
                    const struct texel_hit *at_hit)
{
    struct visit *v = user;
    const struct prt_point point = { v->scene->trace->meshes[hit->geometry].instance, hit->triangle,
                                     hit->u, hit->v, at_hit->back };
    (void)ray;
    (void)local;
    if (!v->hits || at_hit->inside) return;
    const float choice = rng_unit(pcg_hash(v->seed + v->count));
    const uint32_t receiver = prt_receiver_at(&v->scene->receivers, &point, choice);
    if (receiver != CHART_NONE) v->hits[v->count++] = receiver;
}

// ∫ V(ω) (n·ω)₊ Y_i(ω) dω: rays of density (n·ω)/π have the weight π.
static void add_miss(void *user, vec3s direction)
{
    const struct visit *v = user;
    float y[SH_MAX_COUNT];
    sh_eval(v->bands, direction, y);
    for (int i = 0; i < SH_COUNT(v->bands); i++) v->row[i] += y[i];
}

static struct texel_receiver receiver_of(const struct bake_task *task, uint32_t receiver,
                                         vec3s position)
{
    const struct prt_scene *scene = task->job;
    const vec3s normal = prt_receiver_normal(&scene->receivers, receiver);
    return (struct texel_receiver){
        .position = glms_vec3_muladds(normal, prt_receiver_reach(scene, receiver), position),
        .normal = normal,
        .rays = scene->options.rays,
        .light_samples = texel_light_samples(scene->trace, scene->options.rays),
        .seed = (uint32_t)rng_mix(task->bake_seed ^ (uint64_t)receiver << 32) | 1u,
    };
}

static void gather(const struct bake_task *task, const struct texel_receiver *receiver,
                   uint64_t row, struct texel_lights *light)
{
    const struct prt_scene *scene = task->job;
    struct visit visit = { .scene = scene,
                           .seed = receiver->seed,
                           .bands = prt_bands(&scene->options),
                           .row = bake_row(task, OUT_ROWS, row),
                           .hits = prt_has_bounces(&scene->options) ? bake_row(task, OUT_HITS, row)
                                                                    : NULL };
    texel_gather(scene->trace, receiver, &(struct texel_visitor){ add_hit, add_miss, &visit },
                 light);
    for (int i = 0; i < SH_COUNT(visit.bands); i++) visit.row[i] *= GLM_PIf / (float)receiver->rays;
}

// Without shadows rays are traced for emissive surfaces alone.
static void gather_unshadowed(const struct bake_task *task, const struct texel_receiver *receiver,
                              uint64_t row, struct texel_lights *light)
{
    const struct prt_scene *scene = task->job;
    if (receiver->light_samples > 0)
        texel_gather(scene->trace, receiver, &(struct texel_visitor){ 0 }, light);
    light->sky.irradiance = GLM_PIf;
    for (int a = 0; a < 3; a++) light->sky.vector[a] = GLM_PIf * receiver->normal.raw[a];
    prt_unshadowed(prt_bands(&scene->options), receiver->normal, bake_row(task, OUT_ROWS, row));
}

static void make_receiver(const struct bake_task *task, uint32_t i, uint64_t row)
{
    const struct prt_scene *scene = task->job;
    const struct texel_point point = prt_receiver_point(scene, i);
    if (prt_has_bounces(&scene->options))
        memset(bake_row(task, OUT_HITS, row), 0xff, (size_t)scene->options.rays * sizeof(uint32_t));
    memcpy(bake_row(task, OUT_POINT, row), &point, sizeof point);
    if (point.share == 0.0f) return;
    const struct texel_receiver receiver = receiver_of(task, i, point.position);
    struct texel_lights light = { 0 };
    if (scene->options.transfer == PRT_UNSHADOWED)
        gather_unshadowed(task, &receiver, row, &light);
    else
        gather(task, &receiver, row, &light);
    memcpy(bake_row(task, OUT_SKY, row), &light.sky, sizeof light.sky);
    memcpy(bake_row(task, OUT_EMITTED, row), light.emitted, sizeof light.emitted);
    const vec4s albedo = prt_receiver_reflectance(scene, i);
    memcpy(bake_row(task, OUT_ALBEDO, row), albedo.raw, sizeof albedo.raw);
}

static bool run(const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    uint64_t count, first = bake_task_rows(task, OUT_ROWS, &count);
    if (scene->receivers.count == 0) return true;
    for (uint64_t i = 0; i < count; i++) {
        if (bake_task_cancelled(task)) return false;
        make_receiver(task, (uint32_t)(first + i), i);
    }
    return true;
}

bool prt_add_rays(struct bake_plan *plan, const struct prt_scene *scene)
{
    enum { LAST_WAVE = 1 }; // transfer
    const uint64_t texels = light_map_rows(scene->receivers.count);
    const uint64_t rays = (uint64_t)scene->options.rays;
    const uint64_t coefficients = prt_coefficients(&scene->options);
    const size_t tasks = (size_t)((texels + RECEIVERS_PER_TASK - 1) / RECEIVERS_PER_TASK);
    const bool unshadowed = scene->options.transfer == PRT_UNSHADOWED;
    const struct bake_output out[OUT_COUNT] = {
        { PRT_ROWS, TENSOR_F32, 2, { texels, coefficients }, BAKE_ROWS, LAST_WAVE },
        { LIGHT_MAP_ALBEDO, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SKY, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_EMITTED, TENSOR_F32, 3, { texels, 3, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_POINT, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_HITS, TENSOR_U32, 2, { texels, rays }, BAKE_ROWS, LAST_WAVE },
    };
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = "rays",
                  .wave = 0,
                  .task_count = tasks,
                  .run = run,
                  .outputs = out,
                  .output_count = prt_has_bounces(&scene->options) ? OUT_COUNT : OUT_HITS,
                  .rays = unshadowed ? 0 : (double)(texels * rays) / (double)tasks,
                  .texels = (double)texels / (double)tasks });
}
