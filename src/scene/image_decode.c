// The one file that contains stb_image.
#include "scene/image_decode.h"

#include "scene/jpeg_check.h"
#include "scene/png_check.h"
#include "scene/scene.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

// stb_image grows its buffers with the decompressed stream, whatever the image's size: a few
// kilobytes of zlib data can expand to gigabytes. This limit for a single allocation prevents that.
static _Thread_local size_t largest_block;

// Zeroed: an image that refers to missing tables must decode to the same pixels each time.
static void *limited_alloc(size_t bytes)
{
    return bytes <= largest_block ? calloc(1, bytes) : NULL;
}

static void *limited_realloc(void *old, size_t bytes)
{
    return bytes <= largest_block ? realloc(old, bytes) : NULL;
}

#define STBI_MALLOC(bytes)       limited_alloc((bytes))
#define STBI_REALLOC(old, bytes) limited_realloc((old), (bytes))
#define STBI_FREE(block)         free(block)
#define STBI_MAX_DIMENSIONS      SCENE_MAX_IMAGE_SIZE
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
// For the rest of this file: the compiler looks for unused functions at its end.
#pragma GCC diagnostic ignored "-Wunused-function"
#ifndef __clang__ // which does not know it
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <stb_image.h>

// Largest block per pixel: 16-bit RGBA beside its filter bytes, twice for a buffer that grows by
// doubling.
static const size_t BLOCK_BYTES_PER_PIXEL = 18;
static const size_t BLOCK_ALLOWANCE = (size_t)1 << 20;
// A progressive JPEG has about ten scans. A scan can be ten bytes long and costs a pass over all
// pixels.
enum { MAX_JPEG_SCANS = 100 };

enum image_kind image_kind_of(const uint8_t *data, size_t size)
{
    if (size >= 3 && memcmp(data, "\xff\xd8\xff", 3) == 0) return IMAGE_JPEG;
    if (size >= 8 && memcmp(data, "\x89PNG\r\n\x1a\n", 8) == 0) return IMAGE_PNG;
    if (size >= 2 && memcmp(data, "BM", 2) == 0) return IMAGE_BMP;
    return IMAGE_UNKNOWN;
}

static bool too_many_scans(const uint8_t *data, size_t size)
{
    int scans = 0;
    for (size_t i = 0; i + 1 < size && scans <= MAX_JPEG_SCANS; i++) {
        scans += data[i] == 0xff && data[i + 1] == 0xda;
    }
    return scans > MAX_JPEG_SCANS;
}

const char *image_decode_size(const uint8_t *data, size_t size, int *width, int *height)
{
    int channels;
    if (size > INT_MAX) return "it has more than 2 GiB";
    largest_block = BLOCK_ALLOWANCE;
    const bool jpeg = size > 0 && data[0] == 0xff; // fill bytes may precede the second marker byte
    const char *unsound = jpeg ? jpeg_check(data, size) : png_check(data, size);
    if (unsound) return unsound;
    if (!stbi_info_from_memory(data, (int)size, width, height, &channels)) {
        const char *reason = stbi_failure_reason();
        return reason ? reason : "unknown format";
    }
    if (*width < 1 || *height < 1) return "it has no pixels";
    if (*width > SCENE_MAX_IMAGE_SIZE || *height > SCENE_MAX_IMAGE_SIZE) {
        return "it is larger than 8192 x 8192";
    }
    if (jpeg && too_many_scans(data, size)) return "it has more than 100 scans";
    return NULL;
}

const char *image_decode(const uint8_t *data, size_t size, int width, int height, uint8_t *rgba)
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
