// Pictures for the image tests.
#pragma once

#include "framework/test.h"
#include "image/image.h"

// Values that no 16-bit format holds: all of [-1000, 1000], with a few zeros.
static inline void noise_picture(struct image *out, int width, int height, int channels)
{
    CHECK(image_init(out, test_host(), width, height, channels));
    for (size_t i = 0; i < (size_t)width * (size_t)height * (size_t)channels; i++) {
        uint32_t word = (uint32_t)i * 2654435761u + 12345u * (uint32_t)channels;
        word ^= word >> 15, word *= 2246822519u, word ^= word >> 13;
        out->pixels[i] = word % 16 == 0 ? 0.0f : ((float)(word >> 8) / 8388608.0f - 1.0f) * 1000.0f;
    }
}

static inline void flat_picture(struct image *out, int width, int height, int channels, float value)
{
    CHECK(image_init(out, test_host(), width, height, channels));
    for (size_t i = 0; i < (size_t)width * (size_t)height * (size_t)channels; i++)
        out->pixels[i] = value;
}
