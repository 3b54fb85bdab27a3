#include "techniques/mrt/atlas_twin.h"

#include <math.h>

static void fill_tile(const struct mrt_atlas *atlas, const struct mrt_tile *tile,
                      const float *values, int channels, float *out)
{
    int n = atlas->resolution, row = n * channels;
    for (int y = 0; y < n; y++) {
        const float *from = values + (size_t)(tile->first_texel + y * n) * (size_t)channels;
        float *to = out + ((size_t)(tile->y + y) * (size_t)atlas->width + (size_t)tile->x) *
                              (size_t)channels;
        for (int i = 0; i < row; i++) to[i] = from[i];
    }
}

void mrt_atlas_fill(const struct mrt_atlas *atlas, const float *values, int channels, float *out)
{
    for (int t = 0; t < atlas->tile_count; t++)
        fill_tile(atlas, &atlas->tiles[t], values, channels, out);
    for (int i = 0; i < atlas->border_count; i++) {
        const struct mrt_border *border = &atlas->borders[i];
        for (int c = 0; c < channels; c++) {
            float sum = 0.0f;
            for (uint32_t k = 0; k < border->count; k++)
                sum += border->weight[k] * values[border->source[k] * (size_t)channels + (size_t)c];
            out[border->texel * (size_t)channels + (size_t)c] = sum;
        }
    }
}

vec2s mrt_atlas_place(const struct mrt_atlas *atlas, int tile, float s, float t)
{
    const struct mrt_tile *at = &atlas->tiles[tile];
    float n = (float)atlas->resolution;
    return (vec2s){ { (float)at->x + s * n, (float)at->y + t * n } };
}

float mrt_atlas_look_up(const struct mrt_atlas *atlas, const float *filled, int channels,
                        int channel, vec2s place)
{
    float x = place.x - 0.5f, y = place.y - 0.5f, sum = 0.0f;
    int left = (int)floorf(x), top = (int)floorf(y);
    float a = x - (float)left, b = y - (float)top;
    for (int k = 0; k < 4; k++) {
        int i = left + (k & 1), j = top + (k >> 1);
        float weight = (k & 1 ? a : 1.0f - a) * (k >> 1 ? b : 1.0f - b);
        if (weight == 0.0f) continue; // at the border's far side
        sum += weight * filled[((size_t)j * (size_t)atlas->width + (size_t)i) * (size_t)channels +
                               (size_t)channel];
    }
    return sum;
}
