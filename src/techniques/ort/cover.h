// The runs of a map that have texels other than zero, as a summed-area table (Crow 1984,
// "Summed-Area Tables for Texture Mapping"): counts in boxes cost four lookups.
#pragma once

#include "techniques/ort/bins.h"

// Axes of boxes: x in runs of ORT_RUN texels, y in rows.
enum { ORT_X, ORT_Y };

struct ort_box {
    uint32_t from[2], to[2]; // [from, to) of each axis
};

struct ort_cover {
    struct host *host;
    uint32_t width, height; // of a map, in texels
    uint32_t runs;          // of a row
    uint32_t *sums;         // [height + 1][runs + 1] occupied runs before a row and a run
};

bool ort_cover_init(struct ort_cover *cover, struct host *host, uint32_t width, uint32_t height);
void ort_cover_finish(struct ort_cover *cover); // accepts zero
// Takes another map; mask: [height][width]. Returns its number of texels that are not zero.
uint64_t ort_cover_set(struct ort_cover *cover, const uint8_t *mask);

// Shrinks a box to the bounding box of its occupied runs. False: it has none.
bool ort_cover_crop(const struct ort_cover *cover, struct ort_box *box);

// Occupied runs in a box.
static inline uint32_t ort_cover_count(const struct ort_cover *cover, const struct ort_box *box)
{
    const size_t stride = (size_t)cover->runs + 1;
    const uint32_t *top = cover->sums + box->from[ORT_Y] * stride;
    const uint32_t *bottom = cover->sums + box->to[ORT_Y] * stride;
    const uint32_t from = box->from[ORT_X], to = box->to[ORT_X];
    return bottom[to] - bottom[from] - (top[to] - top[from]);
}
