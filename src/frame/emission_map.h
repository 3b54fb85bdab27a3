// CPU mip pyramids of emissive maps and alpha masks, at most EMISSION_MAP_SIZE²: averages over
// footprints of any size.
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

// Averages linear (sRGB-decoded) colours.
bool emission_map_init_color(struct emission_map *out, struct host *host, const struct scene *scene,
                             const struct texture_use *use);
// Averages a mask: 1 where alpha ≥ cutoff, else 0.
bool emission_map_init_mask(struct emission_map *out, struct host *host, const struct scene *scene,
                            const struct texture_use *use, float cutoff);
void emission_map_finish(struct emission_map *map, struct host *host); // accepts zero

// Texture coordinates of a vertex after KHR_texture_transform.
vec2s emission_map_uv(const struct emission_map *map, const vec2s *uv0, const vec2s *uv1,
                      uint32_t vertex);
// Mean over a footprint around transformed coordinates; area 1 is the whole image.
vec3s emission_map_mean(const struct emission_map *map, vec2s uv, float area);
