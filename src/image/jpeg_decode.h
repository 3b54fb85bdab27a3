// JPEG in memory to 8-bit RGBA, by libjpeg-turbo. The bytes are untrusted: memory and work are
// bounded.
#pragma once

#include "image/png_decode.h"

// NULL, or why it failed, in `why`.
const char *jpeg_find_size(const uint8_t *data, size_t size, uint32_t *width, uint32_t *height,
                           char why[DECODE_WHY_SIZE]);
// Writes width × height × 4 bytes, top row first; the size is that of jpeg_find_size.
const char *jpeg_decode(const uint8_t *data, size_t size, uint8_t *rgba, char why[DECODE_WHY_SIZE]);
