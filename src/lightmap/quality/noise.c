// Noise of charts.
#include "lightmap/quality/measures.h"

#include <math.h>
#include <stdlib.h>

// As adaptive.c counts it.
static const double LEAST_LIGHT = 0.01; // over the mean of all

static double least_light(const struct lightmap *map)
{
    double light = 0.0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < map->charts.side_texel_count; i++) {
        if (!(map->texels[i].open > 0.0f)) continue;
        light += (double)map->texels[i].light;
        count++;
    }
    return count > 0 ? fmax(LEAST_LIGHT * light / count, 1e-30) : 1e-30;
}

static float noise_of_unit(const struct lightmap *map, const struct noise_unit *unit, double least)
{
    double variance = 0.0, light = 0.0;
    uint32_t count = 0;
    for (uint32_t i = unit->first; i < unit->first + unit->count; i++) {
        const struct lightmap_texel *texel = &map->texels[i];
        if (!(texel->open > 0.0f)) continue;
        variance += (double)texel->variance;
        light += (double)texel->light;
        count++;
    }
    if (count == 0) return 0.0f;
    return (float)(sqrt(variance / count) / fmax(light / count, least));
}

static bool is_known(const struct lightmap *map)
{
    for (uint32_t i = 0; i < map->charts.side_texel_count; i++)
        if (map->texels[i].open > 0.0f) return isfinite(map->texels[i].variance);
    return false;
}

static void add(struct quality_noise *out, const struct quality_noisy *noisy)
{
    int at = 0;
    while (at < out->count && out->worst[at].noise >= noisy->noise) at++;
    if (at == QUALITY_WORST) return;
    if (out->count < QUALITY_WORST) out->count++;
    for (int i = out->count - 1; i > at; i--) out->worst[i] = out->worst[i - 1];
    out->worst[at] = *noisy;
}

static struct quality_noisy noisy_of(const struct charts *charts, const struct noise_unit *unit,
                                     float noise)
{
    const uint32_t chart = chart_triangle_of(charts, unit->first)->chart;
    const uint32_t last = chart_triangle_of(charts, unit->first + unit->count - 1)->chart;
    return (struct quality_noisy){ .noise = noise,
                                   .chart = chart,
                                   .charts = last - chart + 1,
                                   .texels = unit->count,
                                   .back = chart_is_back(charts, unit->first) };
}

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

bool quality_measure_noise(struct lightmap_quality *q, const struct lightmap *map)
{
    struct noise_units units;
    q->noise.known = is_known(map);
    if (!q->noise.known) return true;
    if (!noise_units_init(&units, &map->charts)) return false;
    const double least = least_light(map);
    float *noise = host_alloc(q->host, units.count, sizeof *noise);
    for (uint32_t i = 0; noise && i < units.count; i++) {
        noise[i] = noise_of_unit(map, &units.at[i], least);
        const struct quality_noisy noisy = noisy_of(&map->charts, &units.at[i], noise[i]);
        add(&q->noise, &noisy);
    }
    if (noise && units.count > 0) {
        qsort(noise, units.count, sizeof *noise, compare);
        q->noise.largest = noise[units.count - 1];
        q->noise.median = noise[units.count / 2];
    }
    host_free(q->host, noise);
    noise_units_finish(&units, q->host);
    return noise;
}
