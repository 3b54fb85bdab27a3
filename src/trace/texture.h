// Material textures with the filtering of the frame's samplers: wrap modes, trilinear.
#pragma once

#include "scene/scene.h"

enum { TEXTURE_LEVELS = 16 };

// An image as sRGB colour, decoded before filtering, or as linear data. All mips have 8 bits, as on
// the GPU.
struct texture {
    int width, height, levels;
    bool srgb;
    const uint8_t *texels[TEXTURE_LEVELS]; // level 0 points into the scene
    uint8_t *owned;                        // memory of the other levels
    float decode[256], unit[256];          // decode: a byte of R, G, B; unit: of A
};

void texture_init(struct texture *texture, const struct scene_image *image, bool srgb);
// Makes the mip levels, for samples of a footprint's size.
bool texture_add_levels(struct texture *texture, struct host *host);
void texture_finish(struct texture *texture, struct host *host); // accepts zero

// A texture with its transform and sampler. texture NULL: no map.
struct texture_map {
    const struct texture *texture;
    int uv_set;
    vec3s row_u, row_v; // uv' = (row_u · (u, v, 1), row_v · (u, v, 1)): KHR_texture_transform
    enum texture_wrap wrap_u, wrap_v;
    bool nearest;
};
struct texture_map texture_map_of(const struct texture_use *use, const struct texture *texture);

// Decoded RGBA. uv: vertex attribute. level: mip level, 0 … levels − 1, may be fractional.
vec4s texture_sample(const struct texture_map *map, vec2s uv, float level);
// Prefetches the texels of texture_sample at level 0.
void texture_prefetch(const struct texture_map *map, vec2s uv);
// Mip level of a pixel with the uv derivatives dx (to the right) and dy (down).
float texture_level(const struct texture_map *map, vec2s dx, vec2s dy);
