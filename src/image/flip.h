// The difference that an observer perceives when flipping between two images: LDR-FLIP (Andersson,
// Nilsson, Akenine-Möller, Oskarsson, Åström & Fairchild 2020, "FLIP: A Difference Evaluator for
// Alternating Images") and HDR-FLIP (Andersson, Nilsson, Shirley & Akenine-Möller 2021,
// "Visualizing Errors in Rendered High Dynamic Range Images").
#pragma once

#include "image/image.h"

// The paper's viewing conditions: a screen 0.7 m wide with 3840 pixels, at a distance of 0.7 m.
#define FLIP_PIXELS_PER_DEGREE     67.0206433f
#define FLIP_PIXELS_PER_DEGREE_MIN 1.0f
#define FLIP_PIXELS_PER_DEGREE_MAX 1000.0f

// Inputs of both maps: images of one size, at least 3 channels, finite. Output: same size, 1
// channel, 0 (no difference) … 1.

// LDR-FLIP of display-linear values, clamped to 0…1. Symmetric in a and b.
bool flip_map(struct host *host, const struct image *a, const struct image *b,
              float pixels_per_degree, struct image *out);

// The exposures of HDR-FLIP, in stops, evenly spaced.
struct flip_exposures {
    double start, stop;
    int count;
};
// From the reference's brightest pixel to its median (2021, section 3.2), over the pixels where
// counts[] is not 0 (NULL: all).
bool flip_exposures_of(struct host *host, const struct image *reference,
                       const unsigned char *counts, struct flip_exposures *out);
// HDR-FLIP of radiance in any unit; negative values count as 0. Per pixel, the largest LDR-FLIP of
// all exposures.
bool flip_map_hdr(struct host *host, const struct image *a, const struct image *b,
                  const struct flip_exposures *exposures, float pixels_per_degree,
                  struct image *out);
