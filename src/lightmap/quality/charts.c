// Density and sizes of charts.
#include "lightmap/quality/measures.h"

#include "scene/charts/raster.h"

#include <math.h>
#include <stdlib.h>

static float density_of(const struct charts *charts, const struct chart *chart)
{
    double texels = 0.0; // area in the atlas
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        const struct raster_polygon polygon =
            raster_polygon_of(charts->triangles[chart->first_triangle + i].place);
        texels += raster_polygon_area(&polygon);
    }
    return chart->area_m2 > 0.0f ? (float)sqrt(texels / (double)chart->area_m2) : 0.0f;
}

static int density_class(const struct charts *charts, float density)
{
    const int middle = DENSITY_CLASSES / 2;
    if (!(density > 0.0f)) return 0;
    const int class = middle + (int)floorf(2.0f * log2f(density / charts->texels_per_m) + 0.5f);
    return class < 0 ? 0 : class < DENSITY_CLASSES ? class : DENSITY_CLASSES - 1;
}

static int size_class(uint32_t texels)
{
    int class = 0;
    while (texels >>= 1) class ++;
    return class < SIZE_CLASSES ? class : SIZE_CLASSES - 1;
}

static void add(struct quality_class *class, double amount)
{
    class->charts++;
    class->amount += amount;
}

static bool is_dark(const struct lightmap *map, const struct chart *chart)
{
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        if (map->texels[chart->first_texel + i].open > 0.0f) return false;
        if (chart->first_back != CHART_NONE && map->texels[chart->first_back + i].open > 0.0f)
            return false;
    }
    return true;
}

// ---- of the surface's area

struct area {
    float density;
    double area_m2;
};

static int by_density(const void *a, const void *b)
{
    const float x = ((const struct area *)a)->density, y = ((const struct area *)b)->density;
    return (x > y) - (x < y);
}

static bool find_median(struct quality_charts *out, const struct lightmap *map)
{
    const struct charts *charts = &map->charts;
    struct area *areas = host_alloc(map->host, charts->count, sizeof *areas);
    double sum = 0.0, below = 0.0;
    uint32_t count = 0, at = 0;
    for (uint32_t i = 0; areas && i < charts->count; i++) {
        if (charts->charts[i].single_texel) continue;
        areas[count++] = (struct area){ out->density[i], (double)charts->charts[i].area_m2 };
        sum += areas[count - 1].area_m2;
    }
    if (count > 0) {
        qsort(areas, count, sizeof *areas, by_density);
        while (at + 1 < count && below + areas[at].area_m2 < 0.5 * sum)
            below += areas[at++].area_m2;
        out->least = areas[0].density;
        out->median = areas[at].density;
    }
    host_free(map->host, areas);
    return areas;
}

bool quality_measure_charts(struct quality_charts *out, const struct lightmap *map)
{
    const struct charts *charts = &map->charts;
    out->density = host_alloc(map->host, charts->count, sizeof *out->density);
    if (!out->density) return false;
    for (uint32_t i = 0; i < charts->count; i++) {
        const struct chart *chart = &charts->charts[i];
        if (!chart->single_texel) {
            out->density[i] = density_of(charts, chart);
            add(&out->densities[density_class(charts, out->density[i])], (double)chart->area_m2);
        }
        add(&out->sizes[size_class(chart->texel_count)], chart->texel_count);
        out->unwrapped += chart->unwrapped;
        out->single_texel += chart->single_texel;
        out->dark += is_dark(map, chart);
    }
    return find_median(out, map);
}
