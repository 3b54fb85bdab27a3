// Neighbours of texels in their charts, over which light is smoothed.
#include "techniques/radiosity/radiosity_state.h"

#include <math.h>

// With R the harmonic mean distance of the hits of a texel's rays, irradiance at distance d differs
// by about d/R (Ward, Rubinstein & Clear 1988, "A Ray Tracing Solution for Diffuse
// Interreflection"): weights fall to 0 where that is 1/4.
static float weight_of(const struct radiosity_surroundings *c, uint32_t a, uint32_t b)
{
    const float *p = c->texels->point + 4 * (size_t)a, *q = c->texels->point + 4 * (size_t)b;
    const float distance = hypotf(hypotf(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
    const float per_m = fmaxf(c->inverse_distance[a], c->inverse_distance[b]);
    return fmaxf(1.0f - 4.0f * distance * per_m, 0.0f);
}

static void fill_neighbours(const struct radiosity *s, const struct radiosity_surroundings *c,
                            uint32_t i, struct chart_share *table)
{
    const struct charts *charts = &s->map.charts;
    const struct chart_texel *t = chart_texel_of(charts, i);
    const uint32_t width = charts->width, height = charts->height;
    const uint32_t top = chart_is_back(charts, i) ? height : 0;
    size_t count = 0;
    for (uint32_t k = 0; k < 9; k++) {
        if (k == 4) continue;                                      // itself
        const uint32_t x = t->x + k % 3 - 1, y = t->y + k / 3 - 1; // below 0: beyond the size
        if (x >= width || y >= height) continue;
        const uint32_t texel = chart_texel_of_place(charts, (size_t)(top + y) * width + x);
        if (texel == CHART_NONE || c->nearest_valid[texel] == i) continue;
        const struct chart_share share = { c->nearest_valid[texel],
                                           weight_of(c, i, c->nearest_valid[texel]) };
        if (share.weight > 0.0f) *light_map_share_at(table, s->map.texel_count, i, count++) = share;
    }
}

// As radiosity_smooth.comp.
static void smooth(const struct radiosity *s, struct chart_share *table, uint32_t i,
                   const float *values, float *out)
{
    float weights = 1.0f;
    for (int k = 0; k < 4; k++) out[k] = values[4 * (size_t)i + (size_t)k];
    for (size_t n = 0; n < RADIOSITY_NEIGHBOURS; n++) {
        const struct chart_share *share = light_map_share_at(table, s->map.texel_count, i, n);
        weights += share->weight;
        for (size_t k = 0; k < 4; k++)
            out[k] += share->weight * values[4 * (size_t)share->texel + k];
    }
    for (int k = 0; k < 4; k++) out[k] /= weights;
}

bool radiosity_upload_neighbours(struct radiosity *s, const struct radiosity_surroundings *c,
                                 float *sky)
{
    const size_t count = (size_t)s->map.texel_count * RADIOSITY_NEIGHBOURS / LIGHT_MAP_PAIR;
    struct chart_share *table =
        host_alloc(s->host, light_map_table_capacity(count), LIGHT_MAP_PAIR * sizeof *table);
    for (uint32_t i = 0; table && i < s->map.texel_count; i++) fill_neighbours(s, c, i, table);
    for (uint32_t i = 0; table && i < s->map.texel_count; i++)
        smooth(s, table, i, c->texels->sky, sky + 4 * (size_t)i);
    return light_map_table_upload(s->host, s->gpu, "neighbours", GPU_RGBA32U, table, count,
                                  &s->tables.neighbours);
}
