// Error metrics of an image `a` against the reference `b`. docs/metrics.md defines each number.
#pragma once

#include "image/image.h"

// Content of the images and selection of pixels. NULL and zeros: display values, every pixel.
struct metrics_options {
    bool radiance;            // false: display-linear values
    float ev;                 // exposure of radiance before the tone mapping for ssim and flip
    const struct image *mask; // NULL, or same size: a pixel counts where any channel is above 0
    bool ignore_not_finite;   // skip NaN and infinite pixels; false: they are an error
    float pixels_per_degree;  // viewing condition of flip; 0: FLIP_PIXELS_PER_DEGREE
};

// Over all pixels that count and the three colour channels, in double.
struct metrics {
    double mse; // mean squared difference
    double mae; // mean absolute difference
    // Mean of (a−b)² / (b² + 0.1²·m²), m the mean luminance of b (1 when that is 0).
    double relmse;
    double psnr;     // dB, for images in 0…1: −10 log10(mse); infinite for equal images
    double ssim;     // mean structural similarity; 1 for equal images
    double flip;     // mean LDR-FLIP, 0…1
    double flip_hdr; // mean HDR-FLIP, 0…1; NaN for display values
    double mean_a[3], mean_b[3];
    size_t counted; // pixels
    size_t ignored; // NaN or infinite in either image, within the mask
};

// Images of the same size with at least 3 channels. NaN or infinite pixels are an error unless
// ignore_not_finite is set, as is a mask without any pixel.
bool metrics_compute(struct host *host, const struct image *a, const struct image *b,
                     const struct metrics_options *options, struct metrics *out);

// The per-pixel error of an error map, averaged over channels.
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
// The same through a dark-to-bright colour map that saturates at `full` (≤ 0: 1 for ssim and flip,
// the 99th percentile otherwise). 3 channels.
bool metrics_error_map(struct host *host, const struct image *a, const struct image *b,
                       const struct metrics_options *options, enum metrics_error error, float full,
                       struct image *out);
