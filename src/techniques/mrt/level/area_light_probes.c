// Light of emitters and the sky at the probes of blocks.
#include "techniques/mrt/level/area_light.h"

#include <math.h>

enum { RAYS = 256 };

struct job {
    const struct mrt_block_map *map;
    int p;
    vec3s *position;
    struct mrt_area_light_probe *probes;
    bool *solid;
};

static int nearest_outside(const struct job *job, int block, int probe)
{
    const int count = mrt_probes_of_block(job->p);
    int nearest = probe;
    float least = INFINITY;
    for (int i = 0; i < count; i++) {
        float distance = glms_vec3_distance2(job->position[block * count + i],
                                             job->position[block * count + probe]);
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

static void find_positions(const struct job *job)
{
    const int per_block = mrt_probes_of_block(job->p);
    for (int i = 0; i < job->map->count * per_block; i++)
        job->position[i] =
            mrt_probe_position(&job->map->blocks[i / per_block], job->p, i % per_block);
}

struct mrt_area_light_probe *mrt_area_light_probes_create(struct host *host,
                                                          const struct mrt_block_map *map, int p,
                                                          const struct trace_scene *scene)
{
    const size_t count = (size_t)map->count * (size_t)mrt_probes_of_block(p);
    struct job job = { .map = map, .p = p };
    job.probes = host_alloc(host, count, sizeof *job.probes);
    job.position = host_alloc(host, count, sizeof *job.position);
    job.solid = host_alloc(host, count, sizeof *job.solid);
    bool ok = job.probes && job.position && job.solid;
    if (ok) {
        find_positions(&job);
        ok = mrt_area_light_points(
            host, scene, RAYS,
            &(struct mrt_area_light_points){ count, job.position, job.probes, job.solid });
    }
    if (ok) {
        replace_solid(&job);
    } else {
        host_free(host, job.probes);
        job.probes = NULL;
    }
    host_free(host, job.position);
    host_free(host, job.solid);
    return job.probes;
}
