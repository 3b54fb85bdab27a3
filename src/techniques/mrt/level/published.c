#include "techniques/mrt/level/published.h"

#include "core/parallel.h"
#include "scene/statics.h"

#include "techniques/mrt/level/wall.h"
#include "trace/texels/light.h"

#include <math.h>

enum { MAX_ALONG_AXIS = 32, RAYS = 576 };

// Not denser than the probes of a block of the mean volume.
static struct frame_probes grid_of(const struct mrt_block_map *map, int p)
{
    struct box3 box = box3_empty();
    for (int b = 0; b < map->count; b++)
        box = box3_union(box, mrt_warp_bounds(map->blocks[b].corner));
    return probe_grid_over(box, fmaxf(mrt_block_map_mean_edge(map) / (float)p,
                                      glms_vec3_max(box3_size(box)) / MAX_ALONG_AXIS));
}

struct job {
    struct mrt_published *out;
    struct trace_scene *trace;
    struct probe_sphere sphere;
};

static float look(void *user, const struct probe_ray *from, bool *inside)
{
    const struct job *job = user;
    const struct ray ray = { from->from, from->direction, 0.0f, INFINITY };
    struct ray_hit hit;
    const bool found = embree_closest(job->trace->embree, &ray, NULL, false, &hit);
    *inside = found && texel_hit_at(job->trace, &ray, &hit).inside;
    return found ? hit.distance : INFINITY;
}

static void trace_probe(void *user, size_t i)
{
    const struct job *job = user;
    const struct frame_probes grid = job->out->grid;
    const struct probe_tracer tracer = { look, user };
    vec3s at;
    const bool valid =
        probe_find_place(&tracer, probe_grid_point(grid, (uint32_t)i), grid.spacing_m, &at);
    job->out->place[i] = probe_offset(grid, (uint32_t)i, vec4_of(at, valid ? 1.0f : 0.0f));
    probe_trace_depths(&job->sphere, &tracer, at, grid.spacing_m, job->out->depth[i]);
}

bool mrt_published_init(struct mrt_published *out, struct host *host, const struct scene_pose *pose,
                        const struct mrt_block_map *map, int p)
{
    *out = (struct mrt_published){ .host = host, .grid = grid_of(map, p) };
    const size_t count = probe_grid_count(out->grid);
    struct scene_statics statics = { 0 };
    struct job job = { .out = out, .sphere = probe_sphere_of(RAYS) };
    out->place = host_alloc(host, count, sizeof *out->place);
    out->depth = host_alloc(host, count, sizeof *out->depth);
    const bool ok = out->place && out->depth && scene_statics_init(&statics, host, pose) &&
                    (job.trace = trace_scene_create(host, &statics.pose));
    if (ok) parallel_for(count, 8, trace_probe, &job);
    trace_scene_destroy(job.trace);
    scene_statics_finish(&statics);
    return ok;
}

void mrt_published_finish(struct mrt_published *published)
{
    if (!published->host) return;
    host_free(published->host, published->place);
    host_free(published->host, published->depth);
    *published = (struct mrt_published){ 0 };
}
