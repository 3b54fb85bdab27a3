// Light of emitters and the sky at points: any, and the probes of blocks.
#include "techniques/mrt/light/area_light.h"

#include "core/rng.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/rays.h"
#include "trace/texels/inside.h"

#include <math.h>

struct job {
    const struct trace_scene *scene;
    struct mrt_rays rays;
    struct mrt_lit_point *points;
};

static void add(vec3s light, const float weight[MRT_PROBE_VALUES], struct mrt_area_light_probe *out)
{
    for (int i = 0; i < MRT_PROBE_VALUES; i++)
        out->emitted[i] = glms_vec3_muladds(light, weight[i], out->emitted[i]);
}

// Whether the point is inside a solid.
static bool gather_rays(const struct job *job, const struct texel_receiver *at,
                        struct mrt_area_light_probe *out, struct mrt_reflector_hits *hits)
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
        struct texel_hit at_hit = texel_hit_at(job->scene, &ray, &hit);
        at_hit.share = 1.0f / (float)job->rays.count;
        const float density = texel_sample_density(at, ray.direction, at_hit.pdf);
        backs += at_hit.back;
        mrt_reflectors_add_hit(hits, job->scene, &ray, &hit, &at_hit);
        add(glms_vec3_scale(at_hit.emission, GLM_PIf * per_sr / density), weight, out);
    }
    mrt_reflectors_drop_inside(hits);
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

static void gather(void *user, size_t i, struct mrt_reflector_hits *hits)
{
    const struct job *job = user;
    struct mrt_lit_point *point = &job->points[i];
    const struct texel_receiver at = {
        .position = point->position,
        .rays = job->rays.count,
        .light_samples = texel_light_samples(job->scene, job->rays.count),
        .seed = pcg_hash((uint32_t)i) | 1u,
    };
    point->solid = gather_rays(job, &at, &point->light, hits);
    sample_emitters(job, &at, &point->light);
}

static struct mrt_reflector_row *row_of(void *user, size_t i)
{
    const struct job *job = user;
    return &job->points[i].light.reflected;
}

bool mrt_area_light_points(const struct trace_scene *scene, struct mrt_reflectors *reflectors,
                           int rays, struct mrt_lit_point *points, size_t count)
{
    struct host *host = reflectors->host;
    struct job job = { .scene = scene, .points = points };
    if (!mrt_rays_init(host, MRT_PROBE, rays, &job.rays)) return false;
    const bool ok =
        mrt_reflectors_gather(reflectors, &(struct mrt_reflector_gather){ .gather = gather,
                                                                          .row_of = row_of,
                                                                          .user = &job,
                                                                          .count = count,
                                                                          .rays = rays,
                                                                          .weight = 4.0f });
    mrt_rays_finish(host, &job.rays);
    return ok;
}

// ---- probes of blocks

enum { PROBE_RAYS = 256 };

// The point itself unless it is in a solid; else the nearest of its block that is not.
static int nearest_outside(const struct mrt_lit_point *points, int per_block, int point)
{
    const int first = point / per_block * per_block;
    int nearest = point;
    float least = INFINITY;
    for (int i = first; points[point].solid && i < first + per_block; i++) {
        float distance = glms_vec3_distance2(points[i].position, points[point].position);
        if (points[i].solid || !(distance < least)) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

struct mrt_area_light_probe *mrt_area_light_probes_create(const struct trace_scene *scene,
                                                          struct mrt_reflectors *reflectors, int p)
{
    struct host *host = reflectors->host;
    const struct mrt_block_map *map = reflectors->grid.map;
    const int per_block = mrt_probes_of_block(p), count = map->count * per_block;
    struct mrt_area_light_probe *out = host_alloc(host, (size_t)count, sizeof *out);
    struct mrt_lit_point *points = host_alloc(host, (size_t)count, sizeof *points);
    bool ok = out && points;
    for (int i = 0; ok && i < count; i++)
        points[i].position = mrt_probe_position(&map->blocks[i / per_block], p, i % per_block);
    ok = ok && mrt_area_light_points(scene, reflectors, PROBE_RAYS, points, (size_t)count);
    for (int i = 0; ok && i < count; i++)
        out[i] = points[nearest_outside(points, per_block, i)].light;
    host_free(host, points);
    if (ok) return out;
    host_free(host, out);
    return NULL;
}
