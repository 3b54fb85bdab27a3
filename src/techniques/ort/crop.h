// Boxes that cover the occupied runs of a map with few empty ones.
#pragma once

#include "techniques/ort/cover.h"

struct ort_crop_node {
    struct ort_box box; // cropped
    uint32_t child;     // its two parts are this node and the next one; 0: it is not cut
    uint32_t cost;      // in texels
    bool kept;
};

struct ort_crop {
    struct host *host;
    const struct ort_cover *cover;
    uint32_t *costs;             // [the longer side of the cover + 1] of the lines before a cut
    struct ort_crop_node *nodes; // a tree; in the end, the nodes before box_count have the boxes
    size_t node_count, capacity;
    size_t box_count;
};

// cover must outlive the object.
bool ort_crop_init(struct ort_crop *crop, struct host *host, const struct ort_cover *cover);
void ort_crop_finish(struct ort_crop *crop); // accepts zero
// Finds boxes of the map that the cover has now. They do not overlap.
bool ort_crop_map(struct ort_crop *crop);
