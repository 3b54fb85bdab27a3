// Structural similarity (Wang, Bovik, Sheikh & Simoncelli 2004, "Image Quality Assessment: From
// Error Visibility to Structural Similarity").
#pragma once

#include "image/image.h"

// out: same size, 1 channel, the index at each pixel, at most 1; 1 where both images are equal over
// the window. a and b: display-linear, 0…1 (clamped), finite, of one size, at least 3 channels; the
// index is of their sRGB-encoded luminance. Border pixels are repeated outwards; the paper skips
// windows at the border.
bool ssim_map(struct host *host, const struct image *a, const struct image *b, struct image *out);
