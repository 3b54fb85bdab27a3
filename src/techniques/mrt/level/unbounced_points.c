// Light of emitters and the sky at points.
#include "unbounced_points.h"

#include "core/parallel.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/rays.h"

struct job {
    const struct mrt_emitter_samples *samples;
    struct mrt_rays rays;
    const struct mrt_unbounced_points *points;
};

static void add(vec3s light, const float weight[MRT_PROBE_VALUES], struct mrt_unbounced_probe *out)
{
    for (int i = 0; i < MRT_PROBE_VALUES; i++)
        out->emitted[i] = glms_vec3_muladds(light, weight[i], out->emitted[i]);
}

// More back than front faces: inside a solid.
static bool gather_rays(const struct job *job, const struct mrt_receiver *at,
                        struct mrt_unbounced_probe *out)
{
    int backs = 0;
    for (int k = 0; k < job->rays.count; k++) {
        const float *weight = job->rays.weight + k * job->rays.values;
        struct trace_hit hit;
        vec3s direction = job->rays.direction[k];
        if (!trace_closest(job->samples->scene, at->position, direction, INFINITY, &hit)) {
            for (int i = 0; i < MRT_PROBE_VALUES; i++) out->sky[i] += weight[i];
            continue;
        }
        backs += !hit.front;
        add(mrt_light_of_hit(job->samples, at, direction, &hit), weight, out);
    }
    return 2 * backs > job->rays.count;
}

static void gather_points(const struct job *job, size_t i, const struct mrt_receiver *at,
                          struct mrt_unbounced_probe *out)
{
    const struct mrt_point_subset subset = mrt_points_of(job->samples, i);
    for (int k = subset.first; k < job->samples->emitters->count; k += subset.step) {
        vec3s direction;
        float basis[MRT_PROBE_VALUES], weight[MRT_PROBE_VALUES];
        vec3s light = mrt_light_of_point(job->samples, at, k, &subset, &direction);
        sh_eval(3, direction, basis);
        sh_irradiance(3, basis, weight);
        add(light, weight, out);
    }
}

static void gather(void *user, size_t i)
{
    const struct job *job = user;
    const struct mrt_receiver at = { .position = job->points->position[i] };
    job->points->solid[i] = gather_rays(job, &at, &job->points->light[i]);
    gather_points(job, i, &at, &job->points->light[i]);
}

bool mrt_unbounced_points(struct host *host, struct mrt_emitter_samples *samples, int rays,
                          const struct mrt_unbounced_points *points)
{
    struct job job = { .samples = samples, .points = points };
    samples->rays = rays;
    if (!mrt_rays_init(host, MRT_PROBE, rays, &job.rays)) return false;
    parallel_for(points->count, 8, gather, &job);
    mrt_rays_finish(host, &job.rays);
    return true;
}
