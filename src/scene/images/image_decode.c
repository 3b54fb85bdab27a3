// The one file that contains stb_image, which decodes BMP and TGA.
#include "scene/images/image_decode.h"

#include "image/jpeg_decode.h"
#include "image/png_decode.h"
#include "scene/scene.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

// Limit of a single allocation of stb_image, whatever a file says.
static _Thread_local size_t largest_block;

// Zeroed: an image that refers to missing tables must decode to the same pixels each time.
static void *limited_alloc(size_t bytes)
{
    return bytes <= largest_block ? calloc(1, bytes) : NULL;
}

#define STBI_MALLOC(bytes)       limited_alloc((bytes))
#define STBI_REALLOC(old, bytes) NULL // by decoders that are left out
#define STBI_FREE(block)         free(block)
#define STBI_MAX_DIMENSIONS      SCENE_MAX_IMAGE_SIZE
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
// For the rest of this file: the compiler looks for unused functions at its end.
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#ifndef __clang__ // which does not know it
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <stb_image.h>

// Largest block: the pixels, and what a decoder needs beside them.
static const size_t BLOCK_BYTES_PER_PIXEL = 4;
static const size_t BLOCK_ALLOWANCE = (size_t)1 << 20;

enum image_kind image_kind_of(const uint8_t *data, size_t size)
{
    if (size >= 3 && memcmp(data, "\xff\xd8\xff", 3) == 0) return IMAGE_JPEG;
    if (size >= 8 && memcmp(data, "\x89PNG\r\n\x1a\n", 8) == 0) return IMAGE_PNG;
    if (size >= 2 && memcmp(data, "BM", 2) == 0) return IMAGE_BMP;
    return IMAGE_UNKNOWN;
}

// BMP or TGA.
static const char *find_other_size(const uint8_t *data, size_t size, uint32_t *width,
                                   uint32_t *height)
{
    int w, h, channels;
    if (size > INT_MAX) return "it has more than 2 GiB";
    largest_block = BLOCK_ALLOWANCE;
    if (!stbi_info_from_memory(data, (int)size, &w, &h, &channels)) {
        const char *reason = stbi_failure_reason();
        return reason ? reason : "unknown format";
    }
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    return NULL;
}

static const char *decode_other(const uint8_t *data, size_t size, int width, int height,
                                uint8_t *rgba)
{
    int w = 0, h = 0, channels;
    size_t pixels = (size_t)width * (size_t)height;
    largest_block = pixels * BLOCK_BYTES_PER_PIXEL + BLOCK_ALLOWANCE;
    uint8_t *decoded = stbi_load_from_memory(data, (int)size, &w, &h, &channels, 4);
    if (!decoded) {
        const char *reason = stbi_failure_reason();
        return reason ? reason : "it cannot be decoded";
    }
    bool same = w == width && h == height;
    if (same) memcpy(rgba, decoded, pixels * 4);
    free(decoded);
    return same ? NULL : "its size is contradictory";
}

static const char *find_size(const uint8_t *data, size_t size, uint32_t *width, uint32_t *height,
                             char why[DECODE_WHY_SIZE])
{
    switch (image_kind_of(data, size)) {
    case IMAGE_JPEG:
        return jpeg_find_size(data, size, width, height, why);
    case IMAGE_PNG:
        return png_find_size(data, size, width, height) ? NULL : "it has no PNG header";
    default:
        return find_other_size(data, size, width, height);
    }
}

const char *image_decode_size(const uint8_t *data, size_t size, int *width, int *height,
                              char why[DECODE_WHY_SIZE])
{
    uint32_t w = 0, h = 0;
    const char *problem = find_size(data, size, &w, &h, why);
    if (problem) return problem;
    if (w < 1 || h < 1) return "it has no pixels";
    if (w > SCENE_MAX_IMAGE_SIZE || h > SCENE_MAX_IMAGE_SIZE)
        return "it is larger than 8192 x 8192";
    *width = (int)w;
    *height = (int)h;
    return NULL;
}

const char *image_decode(const uint8_t *data, size_t size, int width, int height, uint8_t *rgba,
                         char why[DECODE_WHY_SIZE])
{
    switch (image_kind_of(data, size)) {
    case IMAGE_JPEG:
        return jpeg_decode(data, size, rgba, why);
    case IMAGE_PNG:
        return png_decode(data, size, (uint32_t)width, (uint32_t)height, rgba, why);
    default:
        return decode_other(data, size, width, height, rgba);
    }
}
