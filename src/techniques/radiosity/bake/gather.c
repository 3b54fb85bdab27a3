#include "techniques/radiosity/bake/gather.h"

#include "techniques/radiosity/bake/shared_samples.h"
#include "trace/texels/walls.h"

#include <math.h>

bool radiosity_scene_init(struct radiosity_scene *scene, struct host *host,
                          const struct scene_pose *pose, const struct radiosity_options *options,
                          struct radiosity_map *map)
{
    *scene = (struct radiosity_scene){ .host = host, .options = *options, .map = *map };
    *map = (struct radiosity_map){ 0 };
    if (!scene_statics_init(&scene->statics, host, pose) ||
        !scene_statics_free_factors(&scene->statics, true))
        return false;
    if (!scene->map.host && !radiosity_map_init(&scene->map, host, &scene->statics.pose, options))
        return false;
    scene->trace = trace_scene_create(host, &scene->statics.pose);
    return scene->trace && radiosity_subdivide(scene);
}

void radiosity_scene_finish(struct radiosity_scene *scene)
{
    if (!scene->host) return;
    trace_scene_destroy(scene->trace);
    scene_statics_finish(&scene->statics);
    host_free(scene->host, scene->beside_wall);
    host_free(scene->host, scene->part);
    host_free(scene->host, scene->is_group);
    radiosity_map_finish(&scene->map);
    *scene = (struct radiosity_scene){ 0 };
}

// ----

uint32_t radiosity_cluster_at(const struct radiosity_scene *scene, const struct ray *ray,
                              const struct ray_hit *hit, const struct texel_hit *at_hit)
{
    const struct charts *charts = &scene->map.charts;
    const int instance = scene->trace->meshes[hit->geometry].instance;
    if (at_hit->inside) return CHART_NONE;
    uint32_t texel = chart_texel_at(charts, instance, hit->triangle, hit->u, hit->v, at_hit->back);
    if (texel == CHART_NONE) return CHART_NONE;
    if (scene->beside_wall[texel])
        texel = texel_before_wall(scene->trace, charts, texel,
                                  glms_vec3_muladds(ray->direction, hit->distance, ray->origin));
    return scene->map.cluster_of[texel];
}

struct visit {
    const struct radiosity_scene *scene;
    struct radiosity_gather *gather;
};

static void add_hit(void *user, const struct ray *ray, const struct ray_hit *hit, vec3s local,
                    const struct texel_hit *at_hit)
{
    static const float LEAST_DISTANCE_M = 1e-6f;
    const struct visit *v = user;
    const float rays = (float)v->scene->options.rays;
    const uint32_t cluster = radiosity_cluster_at(v->scene, ray, hit, at_hit);
    const float per_m = 1.0f / (fmaxf(hit->distance, LEAST_DISTANCE_M) * rays);
    v->gather->nearness =
        glms_vec4_muladds(vec4_of(ray->direction, 1.0f), per_m, v->gather->nearness);
    if (cluster == CHART_NONE) return;
    struct radiosity_factor *factor = &v->gather->factor[cluster];
    if (factor->weight == 0.0f) v->gather->hit[v->gather->hit_count++] = cluster;
    factor->weight += 1.0f / rays;
    factor->along[0] += local.x / (local.z * rays);
    factor->along[1] += local.y / (local.z * rays);
}

void radiosity_gather_clear(struct radiosity_gather *gather)
{
    struct radiosity_factor *factor = gather->factor;
    uint32_t *hit = gather->hit;
    for (uint32_t i = 0; i < gather->hit_count; i++)
        factor[hit[i]] = (struct radiosity_factor){ 0 };
    *gather = (struct radiosity_gather){ .factor = factor, .hit = hit };
}

void radiosity_gather(const struct radiosity_scene *scene, uint32_t texel, vec3s position,
                      uint64_t seed, struct radiosity_gather *gather)
{
    const struct charts *charts = &scene->map.charts;
    const struct chart_texel *place = chart_texel_of(charts, texel);
    const struct chart_triangle *of = chart_triangle_of(charts, texel);
    const struct trace_mesh *mesh = trace_mesh_of(scene->trace, of->instance);
    const vec3s normal = chart_texel_normal(charts, texel);
    const struct texel_receiver receiver = {
        .position = glms_vec3_muladds(normal, mesh->facets[of->triangle].reach, position),
        .normal = normal,
        .rays = scene->options.rays,
        .light_samples = texel_light_samples(scene->trace, scene->options.rays),
        .first = radiosity_shared_part(place->x, place->y) * (uint32_t)scene->options.rays,
        .seed = (uint32_t)rng_mix(seed ^ radiosity_shared_seed(charts, texel)) | 1u,
        .emission = &scene->statics.emission,
    };
    radiosity_gather_clear(gather);
    texel_gather_light(scene->trace, &receiver, add_hit, &(struct visit){ scene, gather },
                       &gather->light);
}
