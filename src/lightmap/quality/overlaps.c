// Texels that belong to more than one part of the surface.
#include "lightmap/quality/measures.h"

#include "scene/charts/raster.h"

#include <math.h>
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

static void touch(struct overlaps *o, size_t place)
{
    const uint32_t chart = o->charts->triangles[o->current].chart;
    if (o->chart[place] == CHART_NONE) o->chart[place] = chart;
    if (o->chart[place] != chart) count_once(o, place, COUNTED_SHARED, &o->out->shared);
}

static void range_of(const struct raster_polygon *polygon, int axis, uint32_t end, uint32_t *first,
                     uint32_t *last)
{
    double least = INFINITY, most = 0.0;
    for (int i = 0; i < polygon->count; i++) {
        least = fmin(least, polygon->at[i][axis]);
        most = fmax(most, polygon->at[i][axis]);
    }
    *first = (uint32_t)fmax(fmin(least, (double)end), 0.0);
    *last = (uint32_t)fmin(ceil(most), (double)end);
}

static void touch_texels(struct overlaps *o)
{
    const struct charts *charts = o->charts;
    const struct raster_polygon whole = raster_polygon_of(charts->triangles[o->current].place);
    uint32_t top, bottom, left, right;
    range_of(&whole, 1, charts->height, &top, &bottom);
    for (uint32_t y = top; y < bottom; y++) {
        const struct raster_polygon row = raster_clip(&whole, 1, (double)y);
        if (row.count < 3) continue;
        range_of(&row, 0, charts->width, &left, &right);
        for (uint32_t x = left; x < right; x++) {
            const struct raster_polygon part = raster_clip(&row, 0, (double)x);
            if (part.count >= 3 && raster_polygon_area(&part) > ROUNDING)
                touch(o, (size_t)y * charts->width + x);
        }
    }
}

static bool cover(void *user, int32_t x, int32_t y)
{
    struct overlaps *o = user;
    const struct charts *charts = o->charts;
    if (x < 0 || y < 0 || (uint32_t)x >= charts->width || (uint32_t)y >= charts->height)
        return true;
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
