#include "techniques/radiosity/probes/stage.h"

#include "core/half.h"
#include "core/rng.h"
#include "core/sh.h"
#include "techniques/common/probes/rays.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include <math.h>
#include <string.h>

enum { PROBES_PER_TASK = 32 };
enum { OUT_SOURCE, OUT_FACTOR, OUT_PLACE, OUT_SKY, OUT_EMISSION, OUT_DEPTH, OUT_COUNT };

enum { SH = 9, DEPTHS = PROBE_DEPTHS };

struct probe {
    vec3s position;                       // moved out of geometry, within its cell
    float valid;                          // 1; 0: all of the cell is inside geometry
    float sky[SH];                        // irradiance of a sky of radiance 1, Σ c_i Y_i
    float emission[EMISSION_COLUMNS][SH]; // of emissive surfaces by columns
    uint16_t depth[PROBE_DEPTHS][2];
};

static void add_sh(vec3s direction, float weight, float *sum)
{
    float basis[SH];
    sh_eval(3, direction, basis);
    for (int i = 0; i < SH; i++) sum[i] += weight * basis[i];
}

// From radiance to irradiance.
static void finish_sh(float *sh)
{
    float radiance[SH];
    memcpy(radiance, sh, sizeof radiance);
    sh_irradiance(3, radiance, sh);
}

static void add_cluster(struct radiosity_gather *gather, uint32_t cluster, vec3s direction,
                        float share)
{
    struct radiosity_factor *factor = &gather->factor[cluster];
    if (factor->weight == 0.0f) gather->hit[gather->hit_count++] = cluster;
    factor->weight += share;
    for (int a = 0; a < 3; a++) factor->along[a] += share * direction.raw[a];
}

// Light that reaches a probe, by rays in equal squares of the octahedral map, each with its solid
// angle: `gather` has the share of the sphere in which a cluster is seen, and its directions.
struct job {
    const struct radiosity_scene *scene;
    struct probe_sphere sphere;
    uint32_t light_samples; // 0: no emissive surfaces
    uint32_t seed;
    struct radiosity_gather *gather; // NULL: hits are not gathered
    struct probe *out;
};

struct sh_sums {
    struct probe *out;
    vec3s direction;
    float density;
};

static void add_column(void *user, int column, float radiance)
{
    const struct sh_sums *to = user;
    add_sh(to->direction, radiance / to->density, to->out->emission[column]);
}

// density: samples of the direction per steradian.
static void add_emission(const struct job *job, uint32_t mesh, vec3s direction, vec3s radiance,
                         float density)
{
    struct sh_sums sums = { job->out, direction, density };
    texel_emission_columns(job->scene->trace, &job->scene->statics.emission, mesh, radiance,
                           add_column, &sums);
}

static void add_hit(const struct job *job, const struct probe_ray *ray,
                    const struct texel_hit *at_hit, uint32_t cluster)
{
    if (glms_vec3_max(at_hit->emission) > 0.0f)
        add_emission(job, at_hit->mesh, ray->direction, at_hit->emission,
                     1.0f / ray->solid_angle + (float)job->light_samples * at_hit->pdf);
    if (cluster != CHART_NONE)
        add_cluster(job->gather, cluster, ray->direction, ray->solid_angle / (4.0f * GLM_PIf));
}

static float trace_ray(void *user, const struct probe_ray *from, bool *inside)
{
    const struct job *job = user;
    const struct ray ray = { from->from, from->direction, 0.0f, INFINITY };
    const bool gathers = job->gather && from->solid_angle > 0.0f;
    struct ray_hit hit;
    *inside = false;
    if (!embree_closest(job->scene->trace->embree, &ray, NULL, false, &hit)) {
        if (gathers) add_sh(ray.direction, from->solid_angle, job->out->sky);
        return INFINITY;
    }
    const struct texel_hit at_hit = texel_hit_at(job->scene->trace, &ray, &hit);
    *inside = at_hit.inside;
    if (gathers) add_hit(job, from, &at_hit, radiosity_cluster_at(job->scene, &ray, &hit, &at_hit));
    return hit.distance;
}

static void sample_emitters(const struct job *job)
{
    for (uint32_t k = 0; k < job->light_samples; k++) {
        struct emitter_sample s;
        if (!texel_sample_emitter(job->scene->trace, job->out->position, NULL, k,
                                  job->light_samples, job->seed, &s))
            continue;
        add_emission(job, s.mesh, s.to_light, s.radiance,
                     1.0f / probe_solid_angle(&job->sphere, s.to_light) +
                         (float)job->light_samples * s.pdf);
    }
}

static void gather_probe(const struct radiosity_scene *scene, struct frame_probes grid,
                         uint32_t probe, uint64_t seed, struct radiosity_gather *gather,
                         struct probe *out)
{
    const int rays = 2 * scene->options.rays;
    struct job job = { .scene = scene,
                       .sphere = probe_sphere_of(rays),
                       .light_samples = (uint32_t)texel_light_samples(scene->trace, rays),
                       .seed = (uint32_t)rng_mix(seed ^ (uint64_t)probe << 32),
                       .out = out };
    const struct probe_tracer tracer = { trace_ray, &job };
    *out = (struct probe){ .valid = 1.0f };
    radiosity_gather_clear(gather);
    if (!probe_find_place(&tracer, probe_grid_point(grid, probe), grid.spacing_m, &out->position)) {
        out->valid = 0.0f;
        return;
    }
    job.gather = gather;
    probe_trace_depths(&job.sphere, &tracer, out->position, grid.spacing_m, out->depth);
    sample_emitters(&job);
    finish_sh(out->sky);
    for (int k = 0; k < scene->statics.emission.count; k++) finish_sh(out->emission[k]);
}

// ---- the stage

bool radiosity_probe_plan(struct bake_plan *plan, struct frame_probes grid,
                          const struct radiosity_probe_size *size,
                          bool (*run)(const struct bake_task *task), size_t scratch_bytes)
{
    const uint64_t probes = probe_grid_count(grid), most = 2 * (uint64_t)size->sources;
    const uint64_t columns = size->columns;
    const struct bake_output out[OUT_COUNT] = {
        { RADIOSITY_PROBE_SOURCE, TENSOR_U32, 2, { probes, most }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_FACTOR, TENSOR_F16, 3, { probes, most, 4 }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_PLACE, TENSOR_F32, 2, { probes, 4 }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_SKY, TENSOR_F32, 2, { probes, SH }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_EMISSION, TENSOR_F32, 3, { probes, columns, SH }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_DEPTH, TENSOR_F16, 3, { probes, DEPTHS, 2 }, BAKE_ROWS, BAKE_SAVED },
    };
    const size_t tasks = (size_t)((probes + PROBES_PER_TASK - 1) / PROBES_PER_TASK);
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "probes",
                                    .wave = 0,
                                    .task_count = tasks,
                                    .run = run,
                                    .outputs = out,
                                    .output_count = OUT_COUNT,
                                    .rays = (double)probes * 2 * size->rays / (double)tasks,
                                    .scratch_bytes = scratch_bytes });
}

static void write_row(const struct bake_task *task, uint64_t i, const struct radiosity_entry *row,
                      uint32_t count)
{
    uint32_t *source = bake_row(task, OUT_SOURCE, i);
    uint16_t(*factor)[4] = bake_row(task, OUT_FACTOR, i);
    for (uint32_t k = 0; k < count; k++) {
        source[k] = row[k].node;
        factor[k][0] = half_from_float(row[k].factor.weight);
        for (int a = 0; a < 3; a++) factor[k][1 + a] = half_from_float(row[k].factor.along[a]);
    }
}

static void write_probe(const struct bake_task *task, uint64_t i, const struct probe *probe,
                        int columns)
{
    float *place = bake_row(task, OUT_PLACE, i);
    memcpy(place, probe->position.raw, sizeof probe->position.raw);
    place[3] = probe->valid;
    memcpy(bake_row(task, OUT_SKY, i), probe->sky, sizeof probe->sky);
    memcpy(bake_row(task, OUT_EMISSION, i), probe->emission,
           (size_t)columns * sizeof *probe->emission);
    memcpy(bake_row(task, OUT_DEPTH, i), probe->depth, sizeof probe->depth);
}

bool radiosity_probe_run(const struct bake_task *task, const struct radiosity_scene *scene,
                         const struct radiosity_probe_scratch *scratch)
{
    const struct frame_probes grid = radiosity_probe_grid(&scene->map, &scene->options);
    const uint64_t most = 2 * (uint64_t)scene->options.sources;
    uint64_t count, first = bake_task_rows(task, OUT_SOURCE, &count);
    for (uint64_t i = 0; i < count; i++) {
        struct probe probe;
        if (bake_task_cancelled(task)) return false;
        gather_probe(scene, grid, (uint32_t)(first + i), task->bake_seed, scratch->gather, &probe);
        const uint32_t entries =
            radiosity_make_row(scratch->rows, scratch->gather, (uint32_t)most,
                               r2_sequence((uint32_t)(first + i)).x, scratch->row);
        write_row(task, i, scratch->row, entries);
        write_probe(task, i, &probe, scene->statics.emission.count);
    }
    return true;
}
