// Neighbours of texels in their charts, over which light is smoothed: those at a distance of one
// texel, and then of three, so that both passes together are a mean over 9 × 9 texels.
#include "techniques/radiosity/radiosity_state.h"

#include <math.h>

static const int STRIDE[RADIOSITY_SMOOTH_PASSES] = { 1, 3 };

struct neighbourhood {
    const struct radiosity *state;
    const struct radiosity_surroundings *around;
};

static vec4s nearness_of(const struct neighbourhood *n, uint32_t texel)
{
    const float *v = n->around->nearness + 4 * (size_t)texel;
    return (vec4s){ { v[0], v[1], v[2], v[3] } };
}

static float weight_of(float difference)
{
    return fmaxf(1.0f - 4.0f * difference, 0.0f);
}

// √(1 − n·n′), of the normals.
static float turn_of(const struct neighbourhood *n, uint32_t a, uint32_t b)
{
    const struct charts *charts = &n->state->map.charts;
    const float cosine =
        glms_vec3_dot(chart_texel_normal(charts, a), chart_texel_normal(charts, b));
    return sqrtf(fmaxf(1.0f - cosine, 0.0f));
}

static float distance_of(const struct neighbourhood *n, uint32_t a, uint32_t b)
{
    const float *p = n->around->texels->point + 4 * (size_t)a;
    const float *q = n->around->texels->point + 4 * (size_t)b;
    return hypotf(hypotf(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
}

// With R the harmonic mean distance of the hits of a texel's rays, irradiance at distance d and
// with normals n, n′ differs by about d/R + √(1 − n·n′) (Ward, Rubinstein & Clear 1988, "A Ray
// Tracing Solution for Diffuse Interreflection"): weights fall to 0 where that is 1/4.
static float far_weight(const struct neighbourhood *n, uint32_t a, uint32_t b)
{
    const float per_m = fmaxf(nearness_of(n, a).w, nearness_of(n, b).w);
    return weight_of(distance_of(n, a, b) * per_m + turn_of(n, a, b));
}

// d/R bounds the difference, but along a wall both texels see the same of it: what is near
// differs by the share of their means of 1/distance and of direction/distance that does.
static float near_weight(const struct neighbourhood *n, uint32_t a, uint32_t b)
{
    const vec4s p = nearness_of(n, a), q = nearness_of(n, b);
    const float mean = 0.5f * (p.w + q.w);
    if (!(mean > 0.0f)) return 0.0f;
    return weight_of(glms_vec4_norm(glms_vec4_sub(p, q)) / mean + turn_of(n, a, b));
}

// The valid texel of the same side of the chart at an offset from a texel; CHART_NONE: none.
static uint32_t neighbour_at(const struct neighbourhood *n, uint32_t i, int x, int y)
{
    const struct charts *charts = &n->state->map.charts;
    const struct chart_texel *t = chart_texel_of(charts, i);
    const uint32_t top = chart_is_back(charts, i) ? charts->height : 0;
    const uint32_t column = t->x + (uint32_t)x, row = t->y + (uint32_t)y; // below 0: beyond it
    if (column >= charts->width || row >= charts->height) return CHART_NONE;
    const uint32_t texel =
        chart_texel_of_place(charts, (size_t)(top + row) * charts->width + column);
    if (texel == CHART_NONE) return CHART_NONE;
    const uint32_t chart = chart_triangle_of(charts, i)->chart;
    return chart_triangle_of(charts, texel)->chart == chart ? n->around->nearest_valid[texel]
                                                            : CHART_NONE;
}

// 1/R of the room in which a texel touches a wall: the least of those some texels away.
static float open_per_m(const struct neighbourhood *n, uint32_t i)
{
    enum { AWAY = 6 };
    float least = nearness_of(n, i).w;
    for (int k = 0; k < 9; k++) {
        const uint32_t texel = neighbour_at(n, i, (k % 3 - 1) * AWAY, (k / 3 - 1) * AWAY);
        if (texel != CHART_NONE) least = fminf(least, nearness_of(n, texel).w);
    }
    return least;
}

// A neighbour in a direction, `stride` texels away. Texels in contact with a surface, whose light
// d/R would leave alone, have that of others along it, with d/R of the room. What is near must not
// differ from texel to texel: a wall may stand between them.
static struct chart_share share_of(const struct neighbourhood *n, uint32_t i, int x, int y,
                                   int stride)
{
    const struct chart_share none = { 0 };
    uint32_t last = i;
    float near = 1.0f, contact = 0.0f;
    for (int step = 1; step <= stride; step++) {
        const uint32_t texel = neighbour_at(n, i, step * x, step * y);
        if (texel == CHART_NONE) return none;
        if (step == 1) contact = 1.0f - far_weight(n, i, texel);
        near *= near_weight(n, last, texel);
        last = texel;
    }
    if (last == i) return none;
    near *= contact * weight_of(distance_of(n, i, last) * open_per_m(n, i));
    return (struct chart_share){ last, fmaxf(far_weight(n, i, last), near) };
}

static void fill_neighbours(const struct neighbourhood *n, uint32_t i, int stride,
                            struct chart_share *table)
{
    const size_t texels = n->state->map.texel_count;
    size_t count = 0;
    for (int k = 0; k < 9; k++) {
        if (k == 4) continue; // itself
        const struct chart_share share = share_of(n, i, k % 3 - 1, k / 3 - 1, stride);
        if (share.weight > 0.0f) *light_map_share_at(table, texels, i, count++) = share;
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

// sky: [texels][4], of all passes.
static bool smooth_sky(const struct radiosity *s, struct chart_share *table, const float *first,
                       float *sky)
{
    const size_t count = s->map.texel_count;
    float *between = host_alloc(s->host, count, 4 * sizeof *between);
    if (!between) return false;
    for (uint32_t i = 0; i < count; i++) smooth(s, table, i, first, between + 4 * (size_t)i);
    table += RADIOSITY_NEIGHBOURS * count;
    for (uint32_t i = 0; i < count; i++) smooth(s, table, i, between, sky + 4 * (size_t)i);
    host_free(s->host, between);
    return true;
}

bool radiosity_upload_neighbours(struct radiosity *s, const struct radiosity_surroundings *c,
                                 float *sky)
{
    const size_t of_pass = (size_t)s->map.texel_count * RADIOSITY_NEIGHBOURS;
    const size_t count = RADIOSITY_SMOOTH_PASSES * of_pass / LIGHT_MAP_PAIR;
    struct chart_share *table =
        host_alloc(s->host, light_map_table_capacity(count), LIGHT_MAP_PAIR * sizeof *table);
    for (size_t pass = 0; table && pass < RADIOSITY_SMOOTH_PASSES; pass++)
        for (uint32_t i = 0; i < s->map.texel_count; i++)
            fill_neighbours(&(struct neighbourhood){ s, c }, i, STRIDE[pass],
                            table + pass * of_pass);
    const bool ok = table && smooth_sky(s, table, c->texels->sky, sky);
    return light_map_table_upload(s->host, s->gpu, "neighbours", GPU_RGBA32U, table, count,
                                  &s->tables.neighbours) &&
           ok;
}
