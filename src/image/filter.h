// Separable filters on planes of floats, band by band: memory grows with the width of an image, not
// with its area. Border pixels are repeated outwards (clamp to edge).
#pragma once

#include "core/host.h"

enum { FILTER_RADIUS_MAX = 160 };

enum filter_shape {
    FILTER_EVEN,          // w(−k) = w(k)
    FILTER_ODD,           // w(−k) = −w(k), w(0) = 0
    FILTER_EVEN_ZERO_SUM, // even, w(0) = −Σ others: a constant gives exactly 0
};

struct filter {
    enum filter_shape shape;
    int radius;                           // at most FILTER_RADIUS_MAX
    float weights[FILTER_RADIUS_MAX + 1]; // of the offsets 0…radius; FILTER_EVEN alone uses [0]
};

// out[x] = Σ over |k| ≤ radius of w(k) in[x + k·step], for 0 ≤ x < count. A step of 1 filters along
// a row, one of a row's length along a column.
void filter_apply(const struct filter *filter, const float *in, size_t step, int count, float *out);

// A horizontal strip of an image with `pad` rows above and below. For each of these rows the first
// pass fills source planes (padded left and right) and filters them horizontally into middle
// planes; for each row of the strip the second pass filters the middle planes vertically.
struct band {
    int width, height, pad; // of the image; pad: the largest radius
    int source_count, middle_count;
    void *user;
    // Called in parallel. row: index in memory; y: row of the image.
    void (*first_pass)(const struct band *band, int row, int y);
    void (*second_pass)(const struct band *band, int row, int y);
    int first, rows; // the strip, set by band_run
    float *sources, *middles;
};

// A source row; valid indices are −pad … width − 1 + pad.
float *band_source(const struct band *band, int plane, int row);
// Repeats the ends of a source row into its padding.
void band_pad_source(const struct band *band, int plane, int row);
// A middle row; rows of a plane are `width` elements apart.
float *band_middle(const struct band *band, int plane, int row);
// Runs both passes over the whole image.
bool band_run(struct band *band, struct host *host);
