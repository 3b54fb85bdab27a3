// Scattered light by regions: each texel nearby belongs to the offset in whose Voronoi region it
// is. The weight of an offset is the integral of the profile over its region. The profile at its
// point times the region's area is the same in the mean only, and has several times the error.
#pragma once

#include "techniques/ort/bake/transfer.h"

// ort_shares_finish accepts zero.
struct ort_shares {
    struct host *host;
    const struct ort_map *map;
    const int32_t *offsets; // [count][x, y] of the group
    uint32_t group, count;
    uint8_t *leads_nearby; // [count] whether it leads from the receiver to a texel nearby
    uint16_t *region_at;   // [2 height − 1][2 width − 1] of an offset of the atlas
};
size_t ort_shares_bytes(const struct ort_map *map); // about
bool ort_shares_init(struct ort_shares *out, const struct bake_task *task);
void ort_shares_finish(struct ort_shares *shares);
// Prepares for texels of a group.
bool ort_shares_select(struct ort_shares *shares, const struct bake_task *task, uint32_t group);
// Adds to the weight of each offset, [count] for each colour. Light is left out where the texel
// that an offset leads to is not near.
void ort_shares_add(struct ort_shares *shares, const struct ort_transfer *transfer,
                    const struct ort_receiver *to, float *const weight[3]);
