// Light of emitters and the sky at points.
#include "techniques/mrt/level/area_light.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/rays.h"
#include "trace/texels/inside.h"

#include <math.h>

struct job {
    const struct trace_scene *scene;
    struct mrt_rays rays;
    const struct mrt_area_light_points *points;
};

static void add(vec3s light, const float weight[MRT_PROBE_VALUES], struct mrt_area_light_probe *out)
{
    for (int i = 0; i < MRT_PROBE_VALUES; i++)
        out->emitted[i] = glms_vec3_muladds(light, weight[i], out->emitted[i]);
}

// Whether the point is inside a solid.
static bool gather_rays(const struct job *job, const struct texel_receiver *at,
                        struct mrt_area_light_probe *out)
{
    const float per_sr = (float)job->rays.count / (4.0f * GLM_PIf);
    int backs = 0;
    for (int k = 0; k < job->rays.count; k++) {
        const float *weight = job->rays.weight + k * job->rays.values;
        const struct ray ray = { at->position, job->rays.direction[k], 0.0f, INFINITY };
        struct ray_hit hit;
        if (!embree_closest(job->scene->embree, &ray, NULL, false, &hit)) {
            for (int i = 0; i < MRT_PROBE_VALUES; i++) out->sky[i] += weight[i];
            continue;
        }
        const struct texel_hit at_hit = texel_hit_at(job->scene, &ray, &hit);
        const float density = texel_sample_density(at, ray.direction, at_hit.pdf);
        backs += at_hit.back;
        add(glms_vec3_scale(at_hit.emission, GLM_PIf * per_sr / density), weight, out);
    }
    return is_inside(backs, job->rays.count);
}

static void sample_emitters(const struct job *job, const struct texel_receiver *at,
                            struct mrt_area_light_probe *out)
{
    const uint32_t count = (uint32_t)at->light_samples;
    for (uint32_t k = 0; k < count; k++) {
        struct emitter_sample s;
        float basis[MRT_PROBE_VALUES], weight[MRT_PROBE_VALUES];
        if (!texel_sample_emitter(job->scene, at->position, NULL, k, count, at->seed, &s)) continue;
        sh_eval(3, s.to_light, basis);
        sh_irradiance(3, basis, weight);
        add(glms_vec3_divs(s.radiance, texel_sample_density(at, s.to_light, s.pdf)), weight, out);
    }
}

static void gather(void *user, size_t i)
{
    const struct job *job = user;
    const struct texel_receiver at = {
        .position = job->points->position[i],
        .rays = job->rays.count,
        .light_samples = texel_light_samples(job->scene, job->rays.count),
        .seed = pcg_hash((uint32_t)i) | 1u,
    };
    job->points->solid[i] = gather_rays(job, &at, &job->points->light[i]);
    sample_emitters(job, &at, &job->points->light[i]);
}

bool mrt_area_light_points(struct host *host, const struct trace_scene *scene, int rays,
                           const struct mrt_area_light_points *points)
{
    struct job job = { .scene = scene, .points = points };
    if (!mrt_rays_init(host, MRT_PROBE, rays, &job.rays)) return false;
    parallel_for(points->count, 8, gather, &job);
    mrt_rays_finish(host, &job.rays);
    return true;
}
