// The filters of FLIP for one viewing distance, all separable.
#pragma once

#include "image/filter.h"

// Contrast sensitivity filters of lightness and the two chromatic channels (blue-yellow is a sum of
// two Gaussians), and the Gaussian with its derivatives that detects edges and points.
enum flip_filter {
    FLIP_LIGHTNESS,
    FLIP_RED_GREEN,
    FLIP_BLUE_YELLOW_WIDE,
    FLIP_BLUE_YELLOW_NARROW,
    FLIP_SMOOTH,    // Gaussian
    FLIP_SLOPE,     // first derivative, detects edges
    FLIP_CURVATURE, // second derivative, detects points
    FLIP_FILTERS
};

struct flip_filters {
    struct filter filter[FLIP_FILTERS];
    float wide_share; // weight of the wide Gaussian in blue-yellow; the narrow one has the rest
    int radius;       // maximum of all filters
};

void flip_filters_make(float pixels_per_degree, struct flip_filters *out);
