#include "lightmap/quality/measures.h"

#include "core/parallel.h"

#include <math.h>

// Light of the map that darker light counts as, over the mean of all.
static const float LEAST_LIGHT = 0.01f;

// ---- light

static float least_light(const struct lightmap *map)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < map->charts.side_texel_count; i++)
        sum += (double)quality_light(map, quality_place(&map->charts, i));
    const double mean = sum / fmax(map->charts.side_texel_count, 1.0);
    return LEAST_LIGHT * (float)mean;
}

// ---- texels inside geometry

struct opening {
    const struct lightmap *map;
    const struct gather_scene *scene;
    float *open;
};

static void find_open(void *user, size_t i)
{
    const struct opening *o = user;
    struct gather_points covered;
    gather_find_open_points(o->scene, (uint32_t)i, &covered);
    o->open[i] = fminf(o->map->texels[i].open * GATHER_POINTS / (float)covered.count, 1.0f);
}

static bool measure_open(struct lightmap_quality *q, const struct lightmap *map,
                         const struct gather_scene *scene)
{
    const uint32_t count = map->charts.side_texel_count;
    q->open = host_alloc(q->host, count, sizeof *q->open);
    if (!q->open) return false;
    parallel_for(count, 64, find_open, &(struct opening){ map, scene, q->open });
    for (uint32_t i = 0; i < count; i++) {
        q->filled += !(q->open[i] > 0.0f);
        q->partly += q->open[i] > 0.0f && q->open[i] < 1.0f;
    }
    return true;
}

// ---- all

bool quality_begin(struct lightmap_quality *out, const struct lightmap *map,
                   const struct seam_closing *closing)
{
    *out = (struct lightmap_quality){ .host = map->host };
    out->seams.before = host_alloc(map->host, closing->seams.count, sizeof *out->seams.before);
    for (uint32_t i = 0; out->seams.before && i < closing->seams.count; i++)
        out->seams.before[i] = quality_light(map, closing->seams.places[i]);
    return out->seams.before;
}

bool quality_measure(struct lightmap_quality *q, const struct lightmap *map,
                     const struct seam_closing *closing, const struct lightmap_tracing *tracing,
                     float wanted)
{
    q->least_light = least_light(map);
    q->charts.wanted = wanted;
    quality_measure_seams(q, map, closing);
    return quality_measure_charts(&q->charts, map) &&
           quality_measure_overlaps(&q->overlaps, &map->charts) &&
           measure_open(q, map, &tracing->scene) &&
           quality_measure_leaks(q, map, &tracing->scene) && quality_measure_noise(q, map);
}

void quality_finish(struct lightmap_quality *q)
{
    if (!q->host) return;
    host_free(q->host, q->charts.density);
    host_free(q->host, q->seams.before);
    host_free(q->host, q->leaks.step);
    host_free(q->host, q->open);
    *q = (struct lightmap_quality){ 0 };
}

// ---- layers

static float value_of(const struct lightmap_quality *q, const struct lightmap *map,
                      enum quality_layer layer, uint32_t texel)
{
    const uint32_t chart = chart_triangle_of(&map->charts, texel)->chart;
    const struct lightmap_texel *t = &map->texels[texel];
    switch (layer) {
    case QUALITY_CHART:
        return (float)chart;
    case QUALITY_DENSITY:
        return q->charts.density[chart];
    case QUALITY_OPEN:
        return q->open[texel];
    case QUALITY_NOISE:
        return sqrtf(t->variance) / fmaxf(t->light, q->least_light);
    case QUALITY_LEAK:
        return q->leaks.step[texel];
    }
    return NAN;
}

bool quality_layer(const struct lightmap_quality *q, const struct lightmap *map,
                   enum quality_layer layer, enum lightmap_side side, struct image *out)
{
    const struct image *like = &map->irradiance[side];
    if (!image_init(out, map->host, like->width, like->height, 1)) return false;
    const size_t places = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < places; i++) out->pixels[i] = NAN;
    for (uint32_t i = 0; i < map->charts.side_texel_count; i++)
        if (chart_is_back(&map->charts, i) == (side == LIGHTMAP_BACK))
            out->pixels[quality_place(&map->charts, i) % places] = value_of(q, map, layer, i);
    return true;
}
