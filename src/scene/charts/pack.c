// The one file that contains stb_rect_pack (skyline, bottom left).
#include "scene/charts/pack.h"

#include <math.h>
#include <stdlib.h>

// Rectangles of equal size keep their order, whatever the C library's qsort does with them.
#define STBRP_SORT sort_rectangles
static void sort_rectangles(void *rectangles, size_t count, size_t size,
                            int (*compare)(const void *, const void *));
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_rect_pack.h>

static int compare_heights(const void *a, const void *b)
{
    const stbrp_rect *p = a, *q = b;
    if (p->h != q->h) return p->h > q->h ? -1 : 1;
    if (p->w != q->w) return p->w > q->w ? -1 : 1;
    return p->id < q->id ? -1 : p->id > q->id;
}

static int compare_order(const void *a, const void *b)
{
    const stbrp_rect *p = a, *q = b;
    return p->id < q->id ? -1 : p->id > q->id;
}

// stb_rect_pack sorts twice: by height, and back into the order of was_packed, which it sets to the
// rectangle's index.
static void sort_rectangles(void *rectangles, size_t count, size_t size,
                            int (*compare)(const void *, const void *))
{
    qsort(rectangles, count, size,
          compare == rect_original_order ? compare_order : compare_heights);
}

static uint32_t atlas_width(const struct charts *charts)
{
    double area = 0.0;
    uint32_t widest = 1;
    for (uint32_t i = 0; i < charts->count; i++) {
        area += (double)charts->charts[i].width * (double)charts->charts[i].height;
        if (charts->charts[i].width > widest) widest = charts->charts[i].width;
    }
    const uint32_t square = (uint32_t)ceil(fmin(sqrt(area), (double)CHART_MAX_SIDE));
    return square > widest ? square : widest;
}

static bool place_all(struct charts *charts, stbrp_rect *rects, stbrp_node *nodes)
{
    stbrp_context context;
    for (uint32_t i = 0; i < charts->count; i++)
        rects[i] = (stbrp_rect){ .id = (int)i,
                                 .w = (int)charts->charts[i].width,
                                 .h = (int)charts->charts[i].height };
    stbrp_init_target(&context, (int)charts->width, CHART_MAX_SIDE, nodes, (int)charts->width);
    if (!stbrp_pack_rects(&context, rects, (int)charts->count)) return false;
    for (uint32_t i = 0; i < charts->count; i++) {
        struct chart *chart = &charts->charts[i];
        chart->x = (uint32_t)rects[i].x;
        chart->y = (uint32_t)rects[i].y;
        if (chart->y + chart->height > charts->height) charts->height = chart->y + chart->height;
    }
    return true;
}

bool pack_charts(struct charts *charts, uint32_t max_texels, bool *packed)
{
    charts->width = atlas_width(charts);
    charts->height = 0;
    *packed = false;
    if (charts->width > CHART_MAX_SIDE) return true;
    stbrp_rect *rects = host_alloc(charts->host, charts->count, sizeof *rects);
    stbrp_node *nodes = host_alloc(charts->host, charts->width, sizeof *nodes);
    const bool ok = rects && nodes;
    if (ok && place_all(charts, rects, nodes))
        *packed = (uint64_t)charts->width * charts->height <= max_texels;
    host_free(charts->host, rects);
    host_free(charts->host, nodes);
    return ok;
}
