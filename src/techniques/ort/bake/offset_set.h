// Offsets of an offset radiance transfer map, and sets of them: hashing with open addressing.
#pragma once

#include "core/host.h"

#include <stdint.h>

// From a texel that receives light to the one that sends it, in texels of the atlas.
struct ort_offset {
    int32_t x, y;
};

// A limit for atlases: the triangulation of offsets is exact up to it (delaunay.h), and products
// fit.
enum { ORT_MOST_SIDE = 1 << 16 };

struct ort_offset_set {
    struct host *host;
    uint64_t *keys; // 0: free
    size_t mask;
};

// An empty set for at most `most` offsets.
bool ort_offset_set_init(struct ort_offset_set *out, struct host *host, size_t most);
void ort_offset_set_finish(struct ort_offset_set *set); // accepts zero
bool ort_offset_set_has(const struct ort_offset_set *set, struct ort_offset offset);
// False where it is in the set already.
bool ort_offset_set_add(struct ort_offset_set *set, struct ort_offset offset);
