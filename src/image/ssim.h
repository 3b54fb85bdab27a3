// Structural similarity (Wang, Bovik, Sheikh & Simoncelli 2004, "Image Quality Assessment: From
// Error Visibility to Structural Similarity").
#pragma once

#include "image/image.h"

// out: same size, 1 channel, the index at each pixel, at most 1; 1 where both images agree over the
// whole window. a and b: display-linear, 0…1 (clamped), finite, of one size, at least 3 channels.
// What is compared is grey as a screen gets it: luminance, sRGB-encoded. Windows that reach over
// the border see its pixels repeated outwards (the paper has none there).
bool ssim_map(struct host *host, const struct image *a, const struct image *b, struct image *out);
