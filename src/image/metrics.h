// How far image `a` is from the reference `b`. docs/metrics.md says what each number means.
#pragma once

#include "image/image.h"

// What the images hold and which pixels count. NULL and zeros: display values, every pixel.
struct metrics_options {
    bool radiance; // else display-linear values
    float ev;      // of radiance: both images are exposed with it and tone-mapped for ssim and flip
    const struct image
        *mask; // NULL, or of the same size: a pixel counts where any channel is above 0 (not NaN)
    bool ignore_not_finite;  // NaN and infinite pixels do not count, where they are else an error
    float pixels_per_degree; // of the screen that flip imagines; 0: FLIP_PIXELS_PER_DEGREE
};

// Over all pixels that count and the three colour channels, in double.
struct metrics {
    double mse; // mean squared difference
    double mae; // mean absolute difference
    double
        relmse; // mean of (a−b)² / (b² + 0.01²·m²), m the mean of b's luminance (1 when that is 0)
    double psnr;     // dB, for images in 0…1: −10 log10(mse); infinite for equal images
    double ssim;     // mean structural similarity; 1 for equal images
    double flip;     // mean LDR-FLIP, 0…1
    double flip_hdr; // mean HDR-FLIP, 0…1; NaN for display values
    double mean_a[3], mean_b[3];
    size_t counted; // pixels
    size_t ignored; // NaN or infinite in either image, within the mask
};

// Same size and at least 3 channels each. NaN or infinite pixels that count are an error that
// counts them (see ignore_not_finite), as is a mask that leaves no pixel.
bool metrics_compute(struct host *host, const struct image *a, const struct image *b,
                     const struct metrics_options *options, struct metrics *out);

// What an error map shows of each pixel. Means over channels.
enum metrics_error {
    METRICS_ABSOLUTE,
    METRICS_SQUARED,
    METRICS_RELATIVE, // relmse's summands
    METRICS_SSIM,     // 1 − ssim
    METRICS_FLIP,
    METRICS_FLIP_HDR, // of radiance only
};
// One channel; pixels that do not count are 0.
bool metrics_errors(struct host *host, const struct image *a, const struct image *b,
                    const struct metrics_options *options, enum metrics_error error,
                    struct image *out);
// The same through a dark-to-bright colour scale that saturates at `full` (≤ 0: 1 for ssim and
// flip, else the 99th percentile). 3 channels.
bool metrics_error_map(struct host *host, const struct image *a, const struct image *b,
                       const struct metrics_options *options, enum metrics_error error, float full,
                       struct image *out);
