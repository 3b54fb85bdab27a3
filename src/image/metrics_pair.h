// Two images checked for comparison, and the selection of pixels that count.
#pragma once

#include "image/metrics.h"

struct metrics_pair {
    struct image a, b;     // finite everywhere: the caller's pixels, or a copy
    bool copied;           // a and b own their pixels
    unsigned char *counts; // [height][width], 0 or 1
    size_t counted, ignored;
};

// Checks sizes, channels, values and mask.
bool metrics_pair_init(struct host *host, const struct image *a, const struct image *b,
                       const struct metrics_options *options, struct metrics_pair *out);
// Accepts a zeroed pair.
void metrics_pair_finish(struct metrics_pair *pair, struct host *host);
