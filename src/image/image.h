// An image in memory: 32-bit floats, interleaved channels, top row first; colours are linear Rec.
// 709.
#pragma once

#include "core/host.h"
#include "core/vec.h"

#include <stdint.h>

struct image {
    int width, height, channels; // channels 1…4
    float *pixels;               // [height][width][channels]
};

// 1 ≤ width, height ≤ IMAGE_MAX_SIZE; zeroed pixels. image_finish accepts a zeroed image.
#define IMAGE_MAX_SIZE 16384
bool image_init(struct image *image, struct host *host, int width, int height, int channels);
void image_finish(struct image *image, struct host *host);

static inline float *image_at(const struct image *image, int x, int y)
{
    return image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}

// The part of width × height from x, y on, which is in `from`.
bool image_part(struct image *out, struct host *host, const struct image *from, int x, int y,
                int width, int height);
// Two images of equal height side by side, with `gap` black columns between.
bool image_side_by_side(struct image *out, struct host *host, const struct image *a,
                        const struct image *b, int gap);
