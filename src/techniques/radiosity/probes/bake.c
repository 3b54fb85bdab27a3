#include "techniques/radiosity/probes/bake.h"

#include "core/rng.h"
#include "core/sh.h"

#include <math.h>

// The distance of what a ray meets; INFINITY: nothing.
static float meet(const struct radiosity_scene *scene, const struct probe_ray *from,
                  struct ray_hit *hit, struct texel_seen *seen)
{
    const struct ray ray = { from->from, from->direction, 0.0f, INFINITY };
    if (!embree_closest(scene->trace->embree, &ray, NULL, false, hit)) return INFINITY;
    *seen = texel_seen_at(scene->trace, &ray, hit);
    return hit->distance;
}

static float look(void *user, const struct probe_ray *ray, bool *inside)
{
    struct ray_hit hit;
    struct texel_seen seen = { .inside = false };
    const float distance = meet(user, ray, &hit, &seen);
    *inside = seen.inside;
    return distance;
}

static void add_sh(vec3s direction, float weight, float *sum, int stride)
{
    float basis[RADIOSITY_SH];
    sh_eval(3, direction, basis);
    for (int i = 0; i < RADIOSITY_SH; i++) sum[i * stride] += weight * basis[i];
}

// From radiance to irradiance.
static void finish_sh(float *sh, int stride)
{
    float radiance[RADIOSITY_SH], irradiance[RADIOSITY_SH];
    for (int i = 0; i < RADIOSITY_SH; i++) radiance[i] = sh[i * stride];
    sh_irradiance(3, radiance, irradiance);
    for (int i = 0; i < RADIOSITY_SH; i++) sh[i * stride] = irradiance[i];
}

static void add_emission(struct radiosity_probe *out, vec3s direction, vec3s radiance,
                         float density)
{
    for (int c = 0; c < 3; c++)
        add_sh(direction, radiance.raw[c] / density, &out->emitted[0][c], 3);
}

static void add_cluster(struct radiosity_gather *gather, uint32_t cluster, vec3s direction,
                        float share)
{
    struct radiosity_factor *factor = &gather->factor[cluster];
    if (factor->weight == 0.0f) gather->met[gather->met_count++] = cluster;
    factor->weight += share;
    for (int a = 0; a < 3; a++) factor->along[a] += share * direction.raw[a];
}

struct job {
    const struct radiosity_scene *scene;
    struct probe_sphere sphere;
    uint32_t light_samples; // 0: no emissive surfaces
    uint32_t seed;
    struct radiosity_gather *gather;
    struct radiosity_probe *out;
};

static float gather_ray(void *user, const struct probe_ray *ray, bool *inside)
{
    struct job *job = user;
    struct ray_hit hit;
    struct texel_seen seen = { .inside = false };
    const float distance = meet(job->scene, ray, &hit, &seen);
    *inside = seen.inside;
    if (!isfinite(distance)) {
        add_sh(ray->direction, ray->solid_angle, job->out->sky, 1);
        return distance;
    }
    const uint32_t cluster = radiosity_cluster_at(job->scene, &hit, &seen);
    if (glms_vec3_max(seen.emission) > 0.0f)
        add_emission(job->out, ray->direction, seen.emission,
                     1.0f / ray->solid_angle + (float)job->light_samples * seen.pdf);
    if (cluster != CHART_NONE)
        add_cluster(job->gather, cluster, ray->direction, ray->solid_angle / (4.0f * GLM_PIf));
    return distance;
}

static void sample_emitters(const struct job *job)
{
    const float across = 2.0f / (float)job->sphere.side;
    for (uint32_t k = 0; k < job->light_samples; k++) {
        struct emitter_sample s;
        if (!texel_sample_emitter(job->scene->trace, job->out->position, NULL, k,
                                  job->light_samples, job->seed, &s))
            continue;
        const vec3s d = s.to_light;
        const float norm = glms_vec3_norm_one(d);
        const float solid_angle = job->sphere.scale * norm * norm * norm * across * across;
        add_emission(job->out, d, s.radiance,
                     1.0f / solid_angle + (float)job->light_samples * s.pdf);
    }
}

void radiosity_probe_gather(const struct radiosity_scene *scene, struct frame_probes grid,
                            uint32_t probe, uint64_t seed, struct radiosity_gather *gather,
                            struct radiosity_probe *out)
{
    *out = (struct radiosity_probe){ .valid = 1.0f };
    radiosity_gather_clear(gather);
    if (!probe_find_place(&(struct probe_tracer){ look, (void *)scene },
                          probe_grid_point(grid, probe), grid.spacing_m, &out->position)) {
        out->valid = 0.0f;
        return;
    }
    const int rays = 2 * scene->options.rays;
    struct job job = { scene,
                       probe_sphere_of(rays),
                       (uint32_t)texel_light_samples(scene->trace, rays),
                       (uint32_t)rng_mix(seed ^ (uint64_t)probe << 32),
                       gather,
                       out };
    probe_trace_depths(&job.sphere, &(struct probe_tracer){ gather_ray, &job }, out->position,
                       grid.spacing_m, out->depth);
    sample_emitters(&job);
    finish_sh(out->sky, 1);
    for (int c = 0; c < 3; c++) finish_sh(&out->emitted[0][c], 3);
}
