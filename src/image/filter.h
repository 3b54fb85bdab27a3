// Separable filters on planes of floats, band by band, so that memory grows with the width of an
// image and not with its area. Beyond its border an image repeats its outermost pixels.
#pragma once

#include "core/host.h"

enum { FILTER_RADIUS_MAX = 160 };

enum filter_shape {
    FILTER_EVEN,          // w(−k) = w(k)
    FILTER_ODD,           // w(−k) = −w(k), w(0) = 0
    FILTER_EVEN_ZERO_SUM, // even, and w(0) balances the others: nothing comes of a constant, to the
                          // last bit
};

struct filter {
    enum filter_shape shape;
    int radius; // at most FILTER_RADIUS_MAX
    float
        weights[FILTER_RADIUS_MAX + 1]; // of the offsets 0…radius; [0] counts for FILTER_EVEN alone
};

// out[x] = Σ over |k| ≤ radius of w(k) in[x + k·step], for 0 ≤ x < count. A step of 1 filters along
// a row, one of a row's length along a column.
void filter_apply(const struct filter *filter, const float *in, size_t step, int count, float *out);

// A horizontal strip of work with `pad` rows above and below. The first pass, for each of its rows,
// fills source planes (padded left and right) and filters them into middle planes; the second reads
// those around each row of the strip.
struct band {
    int width, height, pad; // of the image; pad: the largest radius
    int source_count, middle_count;
    void *user;
    // In parallel. `row` is the row in memory, `y` the image's row that it stands for.
    void (*first_pass)(const struct band *band, int row, int y);
    void (*second_pass)(const struct band *band, int row, int y);
    int first, rows; // the strip, set by band_run
    float *sources, *middles;
};

// The element 0 ≤ x < width of a source row; x may be from −pad to width − 1 + pad.
float *band_source(const struct band *band, int plane, int row);
// Repeats the ends of a source row into its padding.
void band_pad_source(const struct band *band, int plane, int row);
// The rows of a middle plane follow each other by `width` elements.
float *band_middle(const struct band *band, int plane, int row);
// Runs both passes over the whole image.
bool band_run(struct band *band, struct host *host);
