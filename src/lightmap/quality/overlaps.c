// Texels that belong to more than one part of the surface.
#include "lightmap/quality/measures.h"

#include "scene/charts/raster.h"

#include <string.h>

// Parts of a texel that rounding may give to its neighbour, in texels.
static const double ROUNDING = 1e-4;

struct overlaps {
    const struct charts *charts;
    struct quality_overlaps *out;
    uint32_t *chart;    // [places] that touches it, CHART_NONE: none yet
    uint32_t *triangle; // [places] that covers its middle, likewise
    uint8_t *counted;   // [places]
    uint32_t current;   // triangle
};
enum { COUNTED_SHARED = 1, COUNTED_FOLDED = 2 };

static void count_once(struct overlaps *o, size_t place, uint8_t mark, uint32_t *sum)
{
    if (o->counted[place] & mark) return;
    o->counted[place] |= mark;
    ++*sum;
}

static bool is_in_atlas(const struct charts *charts, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && (uint32_t)x < charts->width && (uint32_t)y < charts->height;
}

static bool touch(void *user, int32_t x, int32_t y, const struct raster_polygon *part)
{
    struct overlaps *o = user;
    const struct charts *charts = o->charts;
    const uint32_t chart = charts->triangles[o->current].chart;
    if (!is_in_atlas(charts, x, y) || !(raster_polygon_area(part) > ROUNDING)) return true;
    const size_t place = (size_t)y * charts->width + (size_t)x;
    if (o->chart[place] == CHART_NONE) o->chart[place] = chart;
    if (o->chart[place] != chart) count_once(o, place, COUNTED_SHARED, &o->out->shared);
    return true;
}

static void touch_texels(struct overlaps *o)
{
    const struct raster_polygon whole = raster_polygon_of(o->charts->triangles[o->current].place);
    raster_parts(&whole, touch, o);
}

static bool cover(void *user, int32_t x, int32_t y)
{
    struct overlaps *o = user;
    const struct charts *charts = o->charts;
    if (!is_in_atlas(charts, x, y)) return true;
    const size_t place = (size_t)y * charts->width + (size_t)x;
    const uint32_t before = o->triangle[place];
    o->triangle[place] = o->current;
    if (before != CHART_NONE &&
        charts->triangles[before].chart == charts->triangles[o->current].chart)
        count_once(o, place, COUNTED_FOLDED, &o->out->folded);
    return true;
}

static void cover_middles(struct overlaps *o)
{
    const struct chart_triangle *t = &o->charts->triangles[o->current];
    struct raster_triangle in;
    for (int k = 0; k < 3; k++) {
        in.at[k][0] = (double)t->place[k].x;
        in.at[k][1] = (double)t->place[k].y;
    }
    raster_centres(&in, cover, o);
}

bool quality_measure_overlaps(struct quality_overlaps *out, const struct charts *charts)
{
    const size_t places = (size_t)charts->width * charts->height;
    struct overlaps o = { .charts = charts,
                          .out = out,
                          .chart = host_alloc(charts->host, places, sizeof *o.chart),
                          .triangle = host_alloc(charts->host, places, sizeof *o.triangle),
                          .counted = host_alloc(charts->host, places, sizeof *o.counted) };
    const bool ok = o.chart && o.triangle && o.counted;
    if (ok) {
        memset(o.chart, 0xff, places * sizeof *o.chart);
        memset(o.triangle, 0xff, places * sizeof *o.triangle);
    }
    for (; ok && o.current < charts->triangle_count; o.current++) {
        // All corners of a single-texel chart are at one place.
        if (charts->charts[charts->triangles[o.current].chart].single_texel) continue;
        touch_texels(&o);
        cover_middles(&o);
    }
    host_free(charts->host, o.chart);
    host_free(charts->host, o.triangle);
    host_free(charts->host, o.counted);
    return ok;
}
