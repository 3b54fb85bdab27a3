// Transfer matrices of points in free space, on a grid: coefficients of the radiance that arrives
// there, z_j, by those of distant light (Hong 2015, section 2.5.1.3, neighbourhood transfer). Over
// the whole sphere spherical harmonics are orthonormal, and their own dual basis.
#include "techniques/prt/bake/sent.h"

#include "core/half.h"
#include "core/rng.h"
#include "techniques/common/probes/grid.h"
#include "techniques/common/probes/rays.h"

#include <math.h>
#include <string.h>

enum { PROBES_PER_TASK = 16 };
enum { OUT_MATRIX, OUT_EMITTED, OUT_PLACE, OUT_DEPTH, OUT_COUNT };

static struct frame_probes grid_of(const struct prt_scene *scene)
{
    return probe_grid_around(prt_receivers_bounds(&scene->receivers), scene->options.probe_spacing,
                             prt_probes_most(&scene->options));
}

struct work {
    const struct prt_scene *scene;
    const struct bake_task *task;
    struct prt_sent sent; // with bounces
    struct probe_sphere sphere;
    uint32_t light_samples; // 0: no emissive surfaces
    int bands;              // of the rows
    size_t rows, coefficients, planes;
    bool gathers;        // else rays look for a place
    uint32_t seed, hits; // of the probe; rays that hit a surface
    float matrix[PRT_OUTGOING * PRT_MAX_COEFFICIENTS * 4];
    float emitted[PRT_OUTGOING][3];
};

static void add_radiance(struct work *w, vec3s direction, float solid_angle, const float *radiance)
{
    const size_t width = w->coefficients * w->planes;
    float z[SH_MAX_COUNT];
    sh_eval(w->bands, direction, z);
    for (size_t j = 0; j < w->rows; j++)
        for (size_t i = 0; i < width; i++)
            w->matrix[j * width + i] += solid_angle * z[j] * radiance[i];
}

static void add_emission(struct work *w, vec3s direction, vec3s radiance, float density)
{
    float z[SH_MAX_COUNT];
    sh_eval(w->bands, direction, z);
    for (size_t j = 0; j < w->rows; j++)
        for (size_t c = 0; c < 3; c++) w->emitted[j][c] += z[j] * radiance.raw[c] / density;
}

static void add_sky(struct work *w, const struct probe_ray *ray)
{
    float y[SH_MAX_COUNT], radiance[4 * PRT_MAX_COEFFICIENTS] = { 0 };
    sh_eval(prt_bands(&w->scene->options), ray->direction, y);
    for (size_t i = 0; i < w->coefficients; i++) radiance[i * w->planes] = y[i];
    add_radiance(w, ray->direction, ray->solid_angle, radiance);
}

static void add_hit(struct work *w, const struct probe_ray *ray, const struct ray_hit *hit,
                    const struct texel_hit *at_hit)
{
    if (glms_vec3_max(at_hit->emission) > 0.0f)
        add_emission(w, ray->direction, at_hit->emission,
                     1.0f / ray->solid_angle + (float)w->light_samples * at_hit->pdf);
    const float choice = rng_unit(pcg_hash(w->seed + w->hits++));
    const uint32_t receiver = prt_has_bounces(&w->scene->options)
                                  ? prt_sent_receiver(w->scene, hit, at_hit, choice)
                                  : CHART_NONE;
    if (receiver == CHART_NONE) return;
    float radiance[4 * PRT_MAX_COEFFICIENTS];
    prt_sent_radiance(&w->sent, receiver, radiance);
    add_radiance(w, ray->direction, ray->solid_angle, radiance);
    add_emission(w, ray->direction, prt_sent_emission(&w->sent, receiver), 1.0f / ray->solid_angle);
}

static float trace_ray(void *user, const struct probe_ray *from, bool *inside)
{
    struct work *w = user;
    const struct ray ray = { from->from, from->direction, 0.0f, INFINITY };
    const bool gathers = w->gathers && from->solid_angle > 0.0f;
    struct ray_hit hit;
    *inside = false;
    if (!embree_closest(w->scene->trace->embree, &ray, NULL, false, &hit)) {
        if (gathers) add_sky(w, from);
        return INFINITY;
    }
    const struct texel_hit at_hit = texel_hit_at(w->scene->trace, &ray, &hit);
    *inside = at_hit.inside;
    if (gathers) add_hit(w, from, &hit, &at_hit);
    return hit.distance;
}

static void sample_emitters(struct work *w, vec3s position)
{
    for (uint32_t k = 0; k < w->light_samples; k++) {
        struct emitter_sample s;
        if (!texel_sample_emitter(w->scene->trace, position, NULL, k, w->light_samples, w->seed,
                                  &s))
            continue;
        add_emission(w, s.to_light, s.radiance,
                     1.0f / probe_solid_angle(&w->sphere, s.to_light) +
                         (float)w->light_samples * s.pdf);
    }
}

static void make_probe(struct work *w, uint32_t probe, uint64_t row)
{
    const struct frame_probes grid = grid_of(w->scene);
    const struct probe_tracer tracer = { trace_ray, w };
    const size_t count = w->rows * w->coefficients * w->planes;
    uint16_t *matrix = bake_row(w->task, OUT_MATRIX, row);
    float *place = bake_row(w->task, OUT_PLACE, row);
    vec3s position;
    w->gathers = false;
    w->seed = (uint32_t)rng_mix(w->task->bake_seed ^ (uint64_t)probe << 32) | 1u;
    w->hits = 0;
    if (!probe_find_place(&tracer, probe_grid_point(grid, probe), grid.spacing_m, &position))
        return;
    memcpy(place, position.raw, sizeof position.raw);
    place[3] = 1.0f;
    w->gathers = true;
    memset(w->matrix, 0, sizeof w->matrix);
    memset(w->emitted, 0, sizeof w->emitted);
    probe_trace_depths(&w->sphere, &tracer, position, grid.spacing_m,
                       bake_row(w->task, OUT_DEPTH, row));
    sample_emitters(w, position);
    for (size_t i = 0; i < count; i++) matrix[i] = half_from_float(w->matrix[i]);
    memcpy(bake_row(w->task, OUT_EMITTED, row), w->emitted, w->rows * sizeof *w->emitted);
}

static bool run(const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const int rays = 2 * scene->options.rays;
    struct work *w = host_alloc(task->host, 1, sizeof *w);
    uint64_t count, first = bake_task_rows(task, OUT_MATRIX, &count);
    if (!w) return false;
    w->scene = scene;
    w->task = task;
    w->sphere = probe_sphere_of(rays);
    w->light_samples = (uint32_t)texel_light_samples(scene->trace, rays);
    w->rows = prt_probe_rows(&scene->options);
    w->bands = scene->options.glossy ? PRT_OUTGOING_BANDS : 3;
    w->coefficients = prt_coefficients(&scene->options);
    w->planes = prt_has_bounces(&scene->options) ? 4 : 1;
    bool ok = !prt_has_bounces(&scene->options) || scene->receivers.count == 0 ||
              prt_sent_init(&w->sent, task);
    for (uint64_t i = 0; ok && i < count; i++) {
        ok = !bake_task_cancelled(task);
        if (ok) make_probe(w, (uint32_t)(first + i), i);
    }
    prt_sent_finish(&w->sent);
    host_free(task->host, w);
    return ok;
}

bool prt_add_probes(struct bake_plan *plan, const struct prt_scene *scene)
{
    enum { MULTIPLY_ADD = 2 };
    const uint64_t probes = probe_grid_count(grid_of(scene));
    const uint64_t rows = prt_probe_rows(&scene->options), rays = 2 * (uint64_t)scene->options.rays;
    const uint64_t numbers = prt_dimension(&scene->options), depths = PROBE_DEPTHS;
    const size_t tasks = (size_t)((probes + PROBES_PER_TASK - 1) / PROBES_PER_TASK);
    const struct bake_output out[OUT_COUNT] = {
        { PRT_PROBE_MATRIX, TENSOR_F16, 3, { probes, rows, numbers }, BAKE_ROWS, BAKE_SAVED },
        { PRT_PROBE_EMITTED, TENSOR_F32, 3, { probes, rows, 3 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_PROBE_PLACE, TENSOR_F32, 2, { probes, 4 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_PROBE_DEPTH, TENSOR_F16, 3, { probes, depths, 2 }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(
        plan,
        &(struct bake_stage){
            .name = "probes",
            .wave = PRT_MATRICES_WAVE,
            .task_count = tasks,
            .run = run,
            .outputs = out,
            .output_count = OUT_COUNT,
            .rays = (double)(probes * rays) / (double)tasks,
            .flops = MULTIPLY_ADD * (double)(probes * rays * rows * numbers) / (double)tasks,
            .scratch_bytes = sizeof(struct work) + scene->receivers.count * sizeof(uint32_t) });
}
