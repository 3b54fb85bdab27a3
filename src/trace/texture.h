// Maps of materials, read as the frame's samplers do: wrapped, filtered linearly between texels and
// between mips.
#pragma once

#include "scene/scene.h"

enum { TEXTURE_LEVELS = 16 };

// An image as colours (sRGB, decoded before filtering) or as data. Smaller mips have 8 bits too, as
// on the GPU.
struct texture {
    int width, height, levels;
    bool srgb;
    const uint8_t *texels[TEXTURE_LEVELS]; // the first is the scene's own
    uint8_t *owned;                        // the others
    float decode[256], unit[256];          // of a byte of R, G, B; of A: n / 255
};

bool texture_init(struct texture *texture, struct host *host, const struct scene_image *image,
                  bool srgb);
void texture_finish(struct texture *texture, struct host *host); // accepts zero

// A texture as a material uses it. texture NULL: no map.
struct texture_map {
    const struct texture *texture;
    int uv_set;
    vec3s row_u, row_v; // uv' = (row_u · (u, v, 1), row_v · (u, v, 1)): KHR_texture_transform
    enum texture_wrap wrap_u, wrap_v;
    bool nearest;
};
struct texture_map texture_map_of(const struct texture_use *use, const struct texture *texture);

// RGBA, decoded. uv: of the vertex attribute. level: of the mips, 0 … levels − 1; between two both
// are mixed.
vec4s texture_sample(const struct texture_map *map, vec2s uv, float level);
// What texture_sample will read at level 0 is asked for from memory.
void texture_expect(const struct texture_map *map, vec2s uv);
// The level for a pixel, in which uv changes by dx to the right and by dy downwards.
float texture_level(const struct texture_map *map, vec2s dx, vec2s dy);
