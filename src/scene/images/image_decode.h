// Decodes images (JPEG, PNG; BMP and TGA for OBJ, FBX and X files) to 8-bit RGBA. The bytes are
// untrusted: memory and work are bounded. Thread-safe.
#pragma once

#include "image/png_decode.h"

enum image_kind { IMAGE_UNKNOWN, IMAGE_JPEG, IMAGE_PNG, IMAGE_BMP, IMAGE_TGA };

// From the signature; TGA has none and is reported as unknown.
enum image_kind image_kind_of(const uint8_t *data, size_t size);

// Width and height, both at most SCENE_MAX_IMAGE_SIZE. NULL, or the reason of failure: a constant,
// or in `why`.
const char *image_decode_size(const uint8_t *data, size_t size, int *width, int *height,
                              char why[DECODE_WHY_SIZE]);

// Writes width × height × 4 bytes, top row first; the size is that of image_decode_size.
const char *image_decode(const uint8_t *data, size_t size, int width, int height, uint8_t *rgba,
                         char why[DECODE_WHY_SIZE]);
