#include "lightmap/filter.h"

#include "core/parallel.h"
#include "lightmap/gather.h"

#include <math.h>
#include <string.h>

enum { RADIUS = 5, CHANNELS = LIGHTMAP_COLUMNS };
static const float SPREAD = 2.5f; // standard deviation of the weight by distance, texels
// Standard deviations at which a difference counts 1/e.
static const float PATCH_DEVIATIONS = 1.5f, TEXEL_DEVIATIONS = 2.0f;
static const int NORMAL_POWER = 4;            // the weight is the cosine, squared that often
static const float PLANE[] = { 0.5f, 0.25f }; // texels off the plane: least, and by distance

struct filter {
    const struct charts *charts;
    const float *light; // [side_texel_count][CHANNELS]
    float *out;
    float *patch;    // [side_texel_count] mean luminance of 3 × 3 texels
    float *variance; // [side_texel_count] of it
};

static bool is_open(const struct filter *f, uint32_t texel)
{
    return f->light[CHANNELS * (size_t)texel + LIGHTMAP_SHARE] > 0.0f;
}

static float luminance_of(const struct filter *f, uint32_t texel)
{
    const float *at = f->light + CHANNELS * (size_t)texel;
    return luminance(vec3_of(at[0], at[1], at[2]));
}

// The open texel at a place of the chart's side; CHART_NONE: none.
static uint32_t neighbour(const struct filter *f, uint32_t texel, int dx, int dy)
{
    const struct charts *charts = f->charts;
    const struct chart_texel *t = chart_texel_of(charts, texel);
    const uint32_t index = chart_triangle_of(charts, texel)->chart;
    const struct chart *chart = &charts->charts[index];
    const int x = (int)t->x + dx, y = (int)t->y + dy;
    if (x < (int)chart->x || x >= (int)(chart->x + chart->width) || y < (int)chart->y ||
        y >= (int)(chart->y + chart->height))
        return CHART_NONE;
    const size_t side = chart_is_back(charts, texel) ? (size_t)charts->width * charts->height : 0;
    const uint32_t found =
        chart_texel_of_place(charts, side + (size_t)y * charts->width + (size_t)x);
    if (found == CHART_NONE || !is_open(f, found)) return CHART_NONE;
    if (chart_triangle_of(charts, found)->chart != index) return CHART_NONE;
    const struct chart_texel *own = chart_texel_of(charts, found);
    return (int)own->x == x && (int)own->y == y ? found : CHART_NONE; // not of a gutter
}

// Texels of a tile share their paths: about the same noise. Other texels have noise of their own.
struct tile_noise {
    uint32_t tile;
    float deviation; // sum over texels
};

static void add_noise(struct tile_noise tiles[9], int *count, uint32_t texel, float variance)
{
    const uint32_t tile = texel / GATHER_TILE;
    int i = 0;
    while (i < *count && tiles[i].tile != tile) i++;
    if (i == *count) tiles[(*count)++] = (struct tile_noise){ .tile = tile };
    tiles[i].deviation += sqrtf(fmaxf(variance, 0.0f));
}

static void find_patch(void *user, size_t i)
{
    struct filter *f = user;
    const uint32_t texel = (uint32_t)i;
    struct tile_noise tiles[9];
    int tile_count = 0;
    float sum = 0.0f, variance = 0.0f, count = 0.0f;
    if (!is_open(f, texel)) return;
    for (int k = 0; k < 9; k++) {
        const uint32_t q = neighbour(f, texel, k % 3 - 1, k / 3 - 1);
        if (q == CHART_NONE) continue;
        sum += luminance_of(f, q);
        add_noise(tiles, &tile_count, q, f->light[CHANNELS * (size_t)q + LIGHTMAP_VARIANCE]);
        count += 1.0f;
    }
    for (int k = 0; k < tile_count; k++) variance += tiles[k].deviation * tiles[k].deviation;
    f->patch[i] = sum / count;
    f->variance[i] = variance / (count * count);
}

// ---- means

// By distance, normal and plane: how much of a neighbour's surface is that of the texel.
static float surface_weight(const struct filter *f, uint32_t texel, uint32_t other, float distance)
{
    const struct charts *charts = f->charts;
    const vec3s n = chart_texel_normal(charts, texel);
    const vec3s to = glms_vec3_sub(chart_texel_of(charts, other)->position,
                                   chart_texel_of(charts, texel)->position);
    float weight = fmaxf(glms_vec3_dot(n, chart_texel_normal(charts, other)), 0.0f);
    for (int i = 0; i < NORMAL_POWER; i++) weight *= weight;
    const float off = fabsf(glms_vec3_dot(n, to)) * charts->texels_per_m;
    weight *= fmaxf(1.0f - off / (PLANE[0] + PLANE[1] * distance), 0.0f);
    return weight * expf(-0.5f * distance * distance / (SPREAD * SPREAD));
}

// 1 where two means differ by no more than the noise of both.
static float likeness(float difference, float variance, float deviations)
{
    variance = fmaxf(variance, 0.0f);
    const float beyond = difference * difference - variance;
    if (!(beyond > 0.0f)) return 1.0f;
    return variance > 0.0f ? expf(-beyond / (deviations * deviations * variance)) : 0.0f;
}

// By patches, and by the texels alone: patches hide the edge between two texels.
static float light_weight(const struct filter *f, uint32_t texel, uint32_t other)
{
    const float *a = f->light + CHANNELS * (size_t)texel, *b = f->light + CHANNELS * (size_t)other;
    const float patches = likeness(f->patch[texel] - f->patch[other],
                                   f->variance[texel] + f->variance[other], PATCH_DEVIATIONS);
    const float texels = likeness(luminance_of(f, texel) - luminance_of(f, other),
                                  a[LIGHTMAP_VARIANCE] + b[LIGHTMAP_VARIANCE], TEXEL_DEVIATIONS);
    return fminf(patches, texels);
}

static void filter_texel(void *user, size_t i)
{
    struct filter *f = user;
    const uint32_t texel = (uint32_t)i;
    float sum[3] = { 0, 0, 0 }, weights = 0.0f;
    memcpy(f->out + CHANNELS * i, f->light + CHANNELS * i, CHANNELS * sizeof *f->out);
    if (!is_open(f, texel)) return;
    for (int dy = -RADIUS; dy <= RADIUS; dy++)
        for (int dx = -RADIUS; dx <= RADIUS; dx++) {
            const uint32_t other = neighbour(f, texel, dx, dy);
            if (other == CHART_NONE) continue;
            const float weight =
                surface_weight(f, texel, other, sqrtf((float)(dx * dx + dy * dy))) *
                light_weight(f, texel, other);
            for (int c = 0; c < 3; c++)
                sum[c] += weight * f->light[CHANNELS * (size_t)other + (size_t)c];
            weights += weight;
        }
    for (int c = 0; c < 3; c++) f->out[CHANNELS * i + (size_t)c] = sum[c] / weights;
}

bool lightmap_filter(const struct charts *charts, const float *light, float *out)
{
    const size_t rows = charts->side_texel_count;
    float *patch = host_alloc(charts->host, rows, 2 * sizeof *patch); // and its variance
    if (!patch) return false;
    struct filter f = {
        .charts = charts, .light = light, .out = out, .patch = patch, .variance = patch + rows
    };
    parallel_for(rows, 256, find_patch, &f);
    parallel_for(rows, 64, filter_texel, &f);
    host_free(charts->host, patch);
    return true;
}
