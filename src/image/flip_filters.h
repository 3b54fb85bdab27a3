// The filters of FLIP for one viewing distance, all separable.
#pragma once

#include "image/filter.h"

// What the eye's contrast sensitivity leaves of lightness and the two chromatic channels
// (blue-yellow is a sum of two Gaussians), and the Gaussian with its derivatives that finds edges
// and points.
enum flip_filter {
    FLIP_LIGHTNESS,
    FLIP_RED_GREEN,
    FLIP_BLUE_YELLOW_WIDE,
    FLIP_BLUE_YELLOW_NARROW,
    FLIP_SMOOTH,    // Gaussian
    FLIP_SLOPE,     // its first derivative
    FLIP_CURVATURE, // its second
    FLIP_FILTERS
};

struct flip_filters {
    struct filter filter[FLIP_FILTERS];
    float wide_share; // of the wide Gaussian in blue-yellow; the narrow one has the rest
    int radius;       // the largest
};

void flip_filters_make(float pixels_per_degree, struct flip_filters *out);
