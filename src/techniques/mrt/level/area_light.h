// Direct light of area lights at the texels and probes of a level: emissive surfaces and the sky,
// for which the frame has no shadow maps. Traced once, with the geometry image.
#pragma once

#include "techniques/mrt/level/geometry.h"
#include "techniques/mrt/level/outdoors.h"
#include "techniques/mrt/level/probes.h"

struct mrt_scene_images {
    struct host *host;
    struct mrt_geometry_texel *geometry;     // [texels]
    vec3s *emitted;                          // [texels] irradiance of emissive surfaces, lux
    float *sky;                              // [texels] irradiance of a sky of radiance 1/π
    struct mrt_area_light_probe *area_light; // [blocks · p³]
    struct mrt_outdoors outdoors;
};

// walls: the part of the pose that texels stand for; it may be the pose itself. probes: p, along an
// edge of a block; 0: none. kept: the geometry of the same walls, NULL: it is traced.
bool mrt_scene_images_init(struct host *host, const struct scene_pose *pose,
                           const struct scene_pose *walls, const struct mrt_block_map *map,
                           const struct mrt_atlas *atlas, int probes,
                           const struct mrt_geometry_texel *kept, struct mrt_scene_images *out);
// Light at texels whose geometry is set, without probes.
bool mrt_area_light_texels(struct mrt_scene_images *images, const struct scene_pose *pose,
                           const struct trace_scene *scene, size_t texels);
void mrt_scene_images_finish(struct mrt_scene_images *images); // accepts zero
