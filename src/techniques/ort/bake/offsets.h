// Chooses the offsets of transfer maps by importance (Sunshine-Hill 2006, sections 3.1 and 5.1).
#pragma once

#include "techniques/ort/bake/offset_set.h"

struct ort_offsets_wish {
    uint32_t width, height; // of the atlas, texels: 1…ORT_MOST_SIDE
    uint32_t count;         // of offsets, at least 1
    uint32_t refinements;   // of the density, about
    uint64_t seed;
    // Importance of each of `count` offsets, at least 0: how much light the map of that offset
    // carries. Offsets of one call and of all calls are distinct. False: cancelled or failed.
    bool (*importance)(void *user, const struct ort_offset *offsets, uint32_t count, float *out);
    void *user;
};

// The number of offsets between two texels of an atlas: x in −(width − 1)…width − 1, likewise y.
uint64_t ort_offset_most(uint32_t width, uint32_t height);

// Chooses min(count, ort_offset_most) distinct offsets, sorted by y, then x. About 100 on a regular
// grid, whose hull is the square of all offsets, some around 0, and `refinements` drawn in batches
// of 20 give the importance density; the result is drawn from it. The same seed and importance give
// the same bytes. `importance` is not called where all offsets are chosen, and for an atlas of one
// row or column, whose offsets are equally likely: they span no triangle.
bool ort_choose_offsets(struct host *host, const struct ort_offsets_wish *wish,
                        struct ort_offset *out);
