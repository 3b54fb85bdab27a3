// The transfer maps of a bake, which is untrusted.
#pragma once

#include "techniques/ort/ort_tensors.h"

// weight[texel][offset][colour], halves times ORT_MAP_SCALE. Map group · offsets + offset has the
// texels of a group.
struct ort_maps {
    const struct ort_map *map;
    const int32_t *offset; // [count][2]
    const uint16_t *weight;
    const uint8_t *bytes; // the same in steps of the maps' scales; NULL: of 16 bits
    const uint8_t *level; // [count] of light, see levels.h
    uint32_t offsets;     // of a texel
    uint32_t count;       // of all groups
};
static inline const uint16_t *ort_weight(const struct ort_maps *maps, uint32_t texel, uint32_t k)
{
    return maps->weight + 3 * ((size_t)texel * maps->offsets + k % maps->offsets);
}

// Checks offsets and weights. The map outlives `out`.
bool ort_maps_find(struct ort_maps *out, const struct ort_map *map,
                   const struct ort_options *options, const struct tensors *bake);
// The number of the first of three weights of map k at a place. Weights that no texel an offset
// away belongs to are left out, whatever the bake has there. False: there is none.
bool ort_maps_at(const struct ort_maps *maps, uint32_t k, struct ort_place at, size_t *weight);
// An ort_mask_function; user: struct ort_maps.
bool ort_maps_mask(void *user, uint32_t k, uint8_t *mask);
