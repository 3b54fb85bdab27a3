// What a texture contributes to emission, averaged over footprints of any size on the CPU: the
// colours of an emissive map, or how much of a masked surface is there. A small mean pyramid of the
// image, EMISSION_MAP_SIZE² at most.
#pragma once

#include "scene/scene.h"

#define EMISSION_MAP_SIZE   256 // a power of two
#define EMISSION_MAP_LEVELS 9

struct emission_map {
    const struct texture_use *use;
    int level_count;
    struct emission_level {
        int width, height; // powers of two
        vec3s *texels;
    } levels[EMISSION_MAP_LEVELS];
};

// sRGB-decoded colours of the image that `use` names; linear light is what is averaged.
bool emission_map_init_color(struct emission_map *out, struct host *host, const struct scene *scene,
                             const struct texture_use *use);
// 1 where the image's alpha reaches `least`, else 0.
bool emission_map_init_mask(struct emission_map *out, struct host *host, const struct scene *scene,
                            const struct texture_use *use, float least);
void emission_map_finish(struct emission_map *map, struct host *host); // accepts zero

// The texture's coordinates from the mesh's (KHR_texture_transform), and how areas grow on the way.
vec2s emission_map_uv(const struct emission_map *map, const vec2s *uv0, const vec2s *uv1,
                      uint32_t vertex);
// Mean around `uv`, already transformed, over a footprint of `area` (the whole image is 1).
vec3s emission_map_mean(const struct emission_map *map, vec2s uv, float area);
