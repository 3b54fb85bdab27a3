// How far image `a` is from the reference `b`. Over all pixels and the three colour channels, in double.
#pragma once

#include "image/image.h"

struct metrics {
    double mse;    // mean squared difference
    double mae;    // mean absolute difference
    double relmse; // mean of (a−b)² / (b² + 0.01²·m²), m the mean of b's luminance (1 when that is 0)
    double psnr;   // dB, for images in 0…1: −10 log10(mse); infinite for equal images
    double mean_a[3], mean_b[3];
};

// Same size and at least 3 channels each; NaN or infinite pixels are an error that counts them.
bool metrics_compute(struct host *host, const struct image *a, const struct image *b,
                     struct metrics *out);
// Per-pixel |a−b| (mean over channels) through a dark-to-bright colour scale that saturates at `full` (≤ 0: the 99th
// percentile). 3 channels.
bool metrics_error_map(struct host *host, const struct image *a, const struct image *b, float full,
                       struct image *out);
