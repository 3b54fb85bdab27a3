// PNG files through libpng: 8 bits, sRGB. Values are display-linear 0…1 in memory, sRGB-encoded in
// the file.
#pragma once

#include "image/image.h"
#include "image/srgb.h"

// Encodes with the sRGB curve, clamps to 0…1, NaN becomes 0. 1, 3 or 4 channels. The file is
// replaced atomically.
bool png_write(struct host *host, const char *path, const struct image *image);
// 8 or 16 bits of any colour type, decoded to 3 or 4 linear channels. Untrusted input.
bool png_read(struct host *host, const char *path, struct image *out);
// From the header; the rest of the file may be wrong.
bool png_read_size(struct host *host, const char *path, int *width, int *height);

// 8-bit sRGB pixels as the bytes of a PNG file, owned by the caller (host_free).
bool png_encode(struct host *host, const uint8_t *rgba, int width, int height, uint8_t **out,
                size_t *size);
