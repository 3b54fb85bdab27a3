// Light of emitters and the sky at probes.
#include "probes.h"

#include "techniques/mrt/level/unbounced_samples.h"

#include "core/parallel.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/rays.h"

#include <math.h>

enum { RAYS = 256 };

struct job {
    const struct mrt_block_map *map;
    const struct mrt_emitter_samples *samples;
    struct mrt_rays rays;
    int p;
    struct mrt_unbounced_probe *probes;
    bool *solid;
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
    const int probes = mrt_probes_of_block(job->p);
    const struct mrt_receiver at = {
        .position = mrt_probe_position(&job->map->blocks[(int)i / probes], job->p, (int)i % probes),
    };
    job->solid[i] = gather_rays(job, &at, &job->probes[i]);
    gather_points(job, i, &at, &job->probes[i]);
}

static int nearest_outside(const struct job *job, int block, int probe)
{
    const int count = mrt_probes_of_block(job->p);
    int nearest = probe;
    float least = INFINITY;
    for (int i = 0; i < count; i++) {
        float distance =
            glms_vec3_distance2(mrt_probe_position(&job->map->blocks[block], job->p, i),
                                mrt_probe_position(&job->map->blocks[block], job->p, probe));
        if (job->solid[block * count + i] || !(distance < least)) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

static void replace_solid(const struct job *job)
{
    const int count = mrt_probes_of_block(job->p);
    for (int i = 0; i < job->map->count * count; i++) {
        if (!job->solid[i]) continue;
        int block = i / count;
        job->probes[i] = job->probes[block * count + nearest_outside(job, block, i % count)];
    }
}

struct mrt_unbounced_probe *mrt_unbounced_probes_create(struct host *host,
                                                        const struct mrt_block_map *map, int p,
                                                        struct mrt_emitter_samples *samples)
{
    const size_t count = (size_t)map->count * (size_t)mrt_probes_of_block(p);
    struct job job = { .map = map, .samples = samples, .p = p };
    samples->rays = RAYS;
    job.probes = host_alloc(host, count, sizeof *job.probes);
    job.solid = host_alloc(host, count, sizeof *job.solid);
    bool ok = job.probes && job.solid && mrt_rays_init(host, MRT_PROBE, RAYS, &job.rays);
    if (ok) {
        parallel_for(count, 8, gather, &job);
        replace_solid(&job);
    } else {
        host_free(host, job.probes);
        job.probes = NULL;
    }
    mrt_rays_finish(host, &job.rays);
    host_free(host, job.solid);
    return job.probes;
}
