// Conservative rasterisation: each triangle is clipped to the squares of the texels that it meets.
#include "scene/charts/texels.h"

#include "scene/charts/raster.h"

#include <math.h>
#include <string.h>

// Sums over the parts of a chart's triangles in a texel.
struct cell {
    double area_m2, largest; // of all parts; of the largest one, in texels
    double middle[2];        // of the largest part, in the atlas
    double moment[3];        // of all parts: area times position, world
    uint32_t triangle;
};

struct cells {
    const struct chart *chart;
    struct cell *at; // [chart->width × chart->height]
};

// Barycentric weights of a place in the triangle; rounding may leave it by a little.
static void weigh(const struct chart_triangle *t, const double at[2], double weight[3])
{
    const struct raster_triangle whole = { { { (double)t->place[0].x, (double)t->place[0].y },
                                             { (double)t->place[1].x, (double)t->place[1].y },
                                             { (double)t->place[2].x, (double)t->place[2].y } } };
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        struct raster_triangle part = whole;
        memcpy(part.at[k], at, sizeof part.at[k]);
        weight[k] = fmax(raster_area2(&part) / raster_area2(&whole), 0.0);
        sum += weight[k];
    }
    for (int k = 0; k < 3; k++) weight[k] /= sum;
}

static void position_at(const struct chart_triangle *t, const double weight[3], double out[3])
{
    for (int c = 0; c < 3; c++) {
        out[c] = 0.0;
        for (int k = 0; k < 3; k++) out[c] += weight[k] * (double)t->corner[k].raw[c];
    }
}

static void add_moment(struct cell *cell, const struct chart_triangle *t, const double at[2],
                       double area_m2)
{
    double weight[3], position[3];
    weigh(t, at, weight);
    position_at(t, weight, position);
    for (int c = 0; c < 3; c++) cell->moment[c] += area_m2 * position[c];
}

struct part_of {
    const struct charts *charts;
    struct cells *cells;
    uint32_t triangle;
    double m2_per_texel;
};

static bool add_part(void *user, int32_t x, int32_t y, const struct raster_polygon *part)
{
    const struct part_of *of = user;
    const struct chart *chart = of->cells->chart;
    struct cell *cell =
        &of->cells->at[((uint32_t)y - chart->y) * chart->width + ((uint32_t)x - chart->x)];
    const double area = raster_polygon_area(part);
    double centroid[2];
    if (!(area > 0.0)) return true;
    raster_polygon_centroid(part, centroid);
    cell->area_m2 += area * of->m2_per_texel;
    add_moment(cell, &of->charts->triangles[of->triangle], centroid, area * of->m2_per_texel);
    if (!(area > cell->largest)) return true;
    cell->largest = area;
    cell->triangle = of->triangle;
    for (int a = 0; a < 2; a++) {
        cell->middle[a] = 0.0;
        for (int i = 0; i < part->count; i++) cell->middle[a] += part->at[i][a] / part->count;
    }
    return true;
}

static void add_triangle(const struct charts *charts, uint32_t triangle, struct cells *cells)
{
    const struct chart_triangle *t = &charts->triangles[triangle];
    const struct raster_polygon whole = raster_polygon_of(t->place);
    struct part_of of = { charts, cells, triangle, 0.0 };
    of.m2_per_texel = (double)t->area_m2 / raster_polygon_area(&whole);
    if (isfinite(of.m2_per_texel)) raster_parts(&whole, add_part, &of);
}

// All of a single-texel chart is in one texel, whose triangle is the largest.
static void add_single_texel(const struct charts *charts, struct cells *cells)
{
    const struct chart *chart = cells->chart;
    struct cell *cell = &cells->at[CHART_GUTTER * (chart->width + 1)];
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        const uint32_t t = chart->first_triangle + i;
        const double area = (double)charts->triangles[t].area_m2;
        cell->area_m2 += area;
        if (!(area > cell->largest)) continue;
        cell->largest = area;
        cell->triangle = t;
    }
}

static void add_chart(const struct charts *charts, struct cells *cells)
{
    const struct chart *chart = cells->chart;
    if (chart->single_texel) {
        add_single_texel(charts, cells);
        return;
    }
    for (uint32_t t = 0; t < chart->triangle_count; t++)
        add_triangle(charts, chart->first_triangle + t, cells);
}

static struct chart_texel texel_of(const struct charts *charts, const struct cell *cell, uint32_t x,
                                   uint32_t y)
{
    const struct chart_triangle *t = &charts->triangles[cell->triangle];
    const bool is_single_texel = charts->charts[t->chart].single_texel;
    double weight[3] = { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 }, position[3];
    struct chart_texel texel = { .x = x, .y = y, .triangle = cell->triangle };
    if (!is_single_texel) weigh(t, cell->middle, weight);
    texel.u = (float)weight[1];
    texel.v = (float)weight[2];
    texel.area_m2 = (float)cell->area_m2;
    position_at(t, weight, position);
    for (int c = 0; c < 3; c++) {
        texel.position.raw[c] = (float)position[c];
        texel.centroid.raw[c] =
            (float)(is_single_texel ? position[c] : cell->moment[c] / cell->area_m2);
    }
    return texel;
}

// The offset in the gutter's square that is nearest to a touched texel of the chart. Of equally
// near ones the first.
static uint32_t nearest_texel(const struct chart *chart, const uint32_t *own, uint32_t x,
                              uint32_t y)
{
    uint32_t nearest = CHART_NONE;
    int least = 2 * CHART_GUTTER * CHART_GUTTER + 1;
    for (int dy = -CHART_GUTTER; dy <= CHART_GUTTER; dy++)
        for (int dx = -CHART_GUTTER; dx <= CHART_GUTTER; dx++) {
            const int64_t column = (int64_t)x + dx - chart->x, row = (int64_t)y + dy - chart->y;
            if (column < 0 || row < 0 || column >= chart->width || row >= chart->height) continue;
            const uint32_t texel = own[(size_t)row * chart->width + (size_t)column];
            const int distance = dx * dx + dy * dy;
            if (texel == CHART_NONE || distance >= least) continue;
            least = distance;
            nearest = texel;
        }
    return nearest;
}

static void emit(struct charts *charts, struct chart *chart, const struct cell *cells,
                 uint32_t *own)
{
    chart->first_texel = charts->texel_count;
    for (uint32_t i = 0; i < chart->width * chart->height; i++) {
        own[i] = CHART_NONE;
        if (!(cells[i].largest > 0.0)) continue;
        own[i] = charts->texel_count;
        charts->texels[charts->texel_count++] =
            texel_of(charts, &cells[i], chart->x + i % chart->width, chart->y + i / chart->width);
    }
    chart->texel_count = charts->texel_count - chart->first_texel;
    for (uint32_t y = chart->y; y < chart->y + chart->height; y++)
        for (uint32_t x = chart->x; x < chart->x + chart->width; x++) {
            const uint32_t nearest = nearest_texel(chart, own, x, y);
            // Rectangles of charts overlap where their texels and gutters do not.
            if (nearest != CHART_NONE) charts->owner[(size_t)y * charts->width + x] = nearest;
        }
}

static size_t largest_chart(const struct charts *charts)
{
    size_t most = 0;
    for (uint32_t i = 0; i < charts->count; i++) {
        const size_t texels = (size_t)charts->charts[i].width * charts->charts[i].height;
        if (texels > most) most = texels;
    }
    return most;
}

bool make_chart_texels(struct charts *charts)
{
    const size_t all = (size_t)charts->width * charts->height, most = largest_chart(charts);
    struct host *host = charts->host;
    struct cell *cells = host_alloc(host, most, sizeof *cells);
    uint32_t *own = host_alloc(host, most, sizeof *own);
    charts->owner = host_alloc(host, all, sizeof *charts->owner);
    charts->texels = host_alloc(host, all, sizeof *charts->texels);
    const bool ok = cells && own && charts->owner && charts->texels;
    if (ok) {
        memset(charts->owner, 0xff, all * sizeof *charts->owner);
        for (uint32_t i = 0; i < charts->count; i++) {
            struct chart *chart = &charts->charts[i];
            memset(cells, 0, (size_t)chart->width * chart->height * sizeof *cells);
            struct cells grid = { chart, cells };
            add_chart(charts, &grid);
            emit(charts, chart, cells, own);
        }
    }
    host_free(host, cells);
    host_free(host, own);
    return ok;
}
