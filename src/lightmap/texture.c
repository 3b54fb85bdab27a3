#include "lightmap/texture.h"

#include "image/png_file.h"

#include <math.h>
#include <stdlib.h>

// ---- the range

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// The largest channel that all lit texels but one in a thousand have; 1 where none is lit.
static bool find_range(struct host *host, const struct image *map, float *range)
{
    const size_t count = (size_t)map->width * (size_t)map->height;
    float *most = host_alloc(host, count, sizeof *most);
    size_t lit = 0;
    if (!most) return false;
    for (size_t i = 0; i < count; i++) {
        const float *rgb = map->pixels + 3 * i;
        most[lit] = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
        if (most[lit] > 0.0f) lit++;
    }
    qsort(most, lit, sizeof *most, ascending);
    *range = lit > 0 ? most[lit - 1 - lit / 1000] : 1.0f;
    host_free(host, most);
    return true;
}

// ---- bytes

// Bayer's matrix of 8x8 thresholds, each of 64 values between 0 and 1 once.
static float threshold(int x, int y)
{
    unsigned rank = 0;
    for (int bit = 0; bit < 3; bit++) {
        const unsigned u = (unsigned)x >> bit & 1u, v = (unsigned)y >> bit & 1u;
        rank = rank << 2 | (u ^ v) << 1 | v;
    }
    return ((float)rank + 0.5f) / 64.0f;
}

static uint8_t quantized(float value, float at)
{
    return (uint8_t)fminf(floorf(255.0f * fmaxf(value, 0.0f) + at), 255.0f);
}

static uint8_t *make_pixels(struct host *host, const struct image *map, float range)
{
    uint8_t *out = host_alloc(host, (size_t)map->width * (size_t)map->height, 4);
    for (int y = 0; out && y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            const float *rgb = image_at(map, x, y), at = threshold(x, y);
            uint8_t *pixel = out + 4 * ((size_t)y * (size_t)map->width + (size_t)x);
            for (int c = 0; c < 3; c++) pixel[c] = quantized(rgb[c] / range, at);
            pixel[3] = 255;
        }
    return out;
}

bool lightmap_texture(struct host *host, const struct image *map, uint8_t **png, size_t *size,
                      float *range)
{
    uint8_t *pixels = find_range(host, map, range) ? make_pixels(host, map, *range) : NULL;
    *png = NULL;
    const bool ok = pixels && png_encode(host, pixels, map->width, map->height, png, size);
    host_free(host, pixels);
    return ok;
}
