// Voronoi regions of chosen offsets among all offsets of an atlas (Sunshine-Hill 2006, section 3):
// each offset of the square belongs to the nearest chosen one.
#pragma once

#include "techniques/ort/bake/offset_set.h"

struct ort_span {
    int32_t y, x0, x1; // offsets (x0…x1, y), x1 included
};

// Region i is the spans first[i]…first[i + 1] − 1, by y, one for each row at most: it is convex.
struct ort_regions {
    struct host *host;
    uint32_t count;
    uint32_t *first; // count + 1
    struct ort_span *spans;
};

// Regions of `count` offsets, at least 1, in the square −(width − 1)…width − 1, likewise height;
// sides are at most ORT_MOST_SIDE. Distances are Euclidean; of equally near offsets the first one
// counts. The spans cover every offset once. O(rows · count). `out` is finished on failure.
bool ort_regions_init(struct ort_regions *out, struct host *host, const struct ort_offset *offsets,
                      uint32_t count, uint32_t width, uint32_t height);
void ort_regions_finish(struct ort_regions *regions); // accepts zero
