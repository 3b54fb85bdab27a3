// Encoded images (JPEG, PNG; BMP and TGA for the older scene files) to 8-bit RGBA, through
// stb_image with limits: the bytes are untrusted. Safe to call from several threads at once.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum image_kind { IMAGE_UNKNOWN, IMAGE_JPEG, IMAGE_PNG, IMAGE_BMP, IMAGE_TGA };

// By the first bytes; TGA has none of its own and is never found.
enum image_kind image_kind_of(const uint8_t *data, size_t size);

// Width and height, both at most SCENE_MAX_IMAGE_SIZE. NULL, or why not (a constant).
const char *image_decode_size(const uint8_t *data, size_t size, int *width, int *height);

// Writes width × height × 4 bytes, top row first, for the size that image_decode_size gave. NULL,
// or why not.
const char *image_decode(const uint8_t *data, size_t size, int width, int height, uint8_t *rgba);
