// Images for the image tests.
#pragma once

#include "framework/test.h"
#include "image/image.h"

// Noise in [-1000, 1000] with a few zeros; no 16-bit format represents it exactly.
static inline void noise_image(struct image *out, int width, int height, int channels)
{
    CHECK(image_init(out, test_host(), width, height, channels));
    for (size_t i = 0; i < (size_t)width * (size_t)height * (size_t)channels; i++) {
        uint32_t word = (uint32_t)i * 2654435761u + 12345u * (uint32_t)channels;
        word ^= word >> 15, word *= 2246822519u, word ^= word >> 13;
        out->pixels[i] = word % 16 == 0 ? 0.0f : ((float)(word >> 8) / 8388608.0f - 1.0f) * 1000.0f;
    }
}

static inline void flat_image(struct image *out, int width, int height, int channels, float value)
{
    CHECK(image_init(out, test_host(), width, height, channels));
    for (size_t i = 0; i < (size_t)width * (size_t)height * (size_t)channels; i++)
        out->pixels[i] = value;
}

// Display values in 0…1: blocks and noise. Each seed gives another image.
static inline void display_image(struct image *out, int width, int height, int channels, int seed)
{
    CHECK(image_init(out, test_host(), width, height, channels));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < channels; c++) {
                uint32_t word = (uint32_t)(((y * width + x) * 4 + c) * 64 + seed) * 2654435761u;
                word ^= word >> 15, word *= 2246822519u, word ^= word >> 13;
                float shape = (float)((x / 7 + y / 5 + c + seed) % 3) / 3.0f;
                image_at(out, x, y)[c] = 0.6f * shape + 0.4f * (float)(word >> 8) / 16777216.0f;
            }
}

// image = share · other + (1 − share) · image
static inline void blend(struct image *image, const struct image *other, float share)
{
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        for (size_t c = 0; c < 3; c++) {
            float *to = &image->pixels[i * (size_t)image->channels + c];
            *to += share * (other->pixels[i * (size_t)other->channels + c] - *to);
        }
}
