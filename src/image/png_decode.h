// PNG in memory to 8-bit RGBA, by libpng. The bytes are untrusted: memory and work are bounded.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Bytes of a decoder's reason of failure.
enum { DECODE_WHY_SIZE = 200 };

// A signature and the chunk IHDR, which is the first and begins with the size (PNG specification,
// section 5.6); libpng takes others before it. False: there is no such head.
bool png_find_size(const uint8_t *data, size_t size, uint32_t *width, uint32_t *height);

// Writes width × height × 4 bytes, top row first. 16-bit samples give their upper byte; gAMA and
// iCCP are ignored. NULL, or why it failed, in `why`.
const char *png_decode(const uint8_t *data, size_t size, uint32_t width, uint32_t height,
                       uint8_t *rgba, char why[DECODE_WHY_SIZE]);
