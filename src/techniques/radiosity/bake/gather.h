// Light that reaches a texel, by rays: form factors of the clusters, the sky, emissive surfaces.
#pragma once

#include "trace/texels/light.h"
#include "trace/texels/texels.h"

#include "techniques/radiosity/radiosity_map.h"
#include "scene/statics.h"

// Scene data that all tasks share. radiosity_scene_finish accepts zero.
struct radiosity_scene {
    struct host *host;
    struct scene_statics statics;
    struct radiosity_options options;
    struct radiosity_map map;
    struct trace_scene *trace;
    bool *beside_wall; // [texels]
    uint8_t *part;     // [texels]
    bool *is_group;    // [nodes] clusters of it see each other
};
// map: taken over, without parts; zero: it is made.
bool radiosity_scene_init(struct radiosity_scene *scene, struct host *host,
                          const struct scene_pose *pose, const struct radiosity_options *options,
                          struct radiosity_map *map);
void radiosity_scene_finish(struct radiosity_scene *scene);

// Sums over rays: the share of those that meet a cluster, and of a texel the components of their
// directions over the cosine along its tangents (basis_of); of a probe their directions.
struct radiosity_factor {
    float weight, along[3];
};

struct radiosity_gather {
    struct radiosity_factor *factor; // [clusters], in shares of 1
    uint32_t *hit;                   // clusters whose factor is not 0, in the order of the rays
    uint32_t hit_count;
    struct texel_lights light;
    vec4s nearness; // mean over the rays of direction/distance; w: of 1/distance, 1/m
};

// The cluster that a ray meets; CHART_NONE: none.
uint32_t radiosity_cluster_at(const struct radiosity_scene *scene, const struct ray *ray,
                              const struct ray_hit *hit, const struct texel_hit *at_hit);

// ---- subdivide.c

// Texels beside walls, parts of all texels, the clusters that follow, and which nodes are groups.
bool radiosity_subdivide(struct radiosity_scene *scene);
// Whether two texels see each other a little above the surface.
bool radiosity_texels_see(const struct radiosity_scene *scene, uint32_t a, uint32_t b);

// ----

// position: of the texel. Clears what the last call left in *gather, whose arrays are zeroed before
// the first one.
void radiosity_gather(const struct radiosity_scene *scene, uint32_t texel, vec3s position,
                      uint64_t seed, struct radiosity_gather *gather);

// Clears the result of the last call.
void radiosity_gather_clear(struct radiosity_gather *gather);
