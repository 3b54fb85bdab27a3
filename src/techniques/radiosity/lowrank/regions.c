#include "techniques/radiosity/lowrank/regions.h"

#include <math.h>
#include <stdlib.h>

enum { SOURCES_PER_FORM_FACTOR = 8 }; // of a region, over those of a sparse row

uint32_t radiosity_lowrank_sources(const struct radiosity_options *options)
{
    return SOURCES_PER_FORM_FACTOR * (uint32_t)options->sources;
}

uint32_t radiosity_lowrank_modes(const struct radiosity_options *options)
{
    const uint32_t modes = (uint32_t)options->modes + RADIOSITY_MODES - 1;
    return modes / RADIOSITY_MODES * RADIOSITY_MODES;
}

struct item {
    float key;
    uint32_t texel;
};

// Of a normal's coordinates, in shares of a set's size: two sides of a wall part before two ends.
static const float NORMAL_SHARE = 0.5f;

static float coordinate(const struct radiosity_map *map, uint32_t texel, int axis)
{
    return axis < 3 ? radiosity_chart_texel(map, texel)->position.raw[axis]
                    : map->texels[texel].normal.raw[axis - 3];
}

static float extent_of(const struct radiosity_map *map, const struct item *items, size_t count,
                       int axis)
{
    float low = coordinate(map, items[0].texel, axis), high = low;
    for (size_t i = 1; i < count; i++) {
        const float at = coordinate(map, items[i].texel, axis);
        low = fminf(low, at);
        high = fmaxf(high, at);
    }
    return high - low;
}

static int widest_axis(const struct radiosity_map *map, const struct item *items, size_t count)
{
    float extent[6], size = 0.0f;
    for (int axis = 0; axis < 6; axis++) extent[axis] = extent_of(map, items, count, axis);
    for (int axis = 0; axis < 3; axis++) size += extent[axis] * extent[axis];
    for (int axis = 3; axis < 6; axis++) extent[axis] *= NORMAL_SHARE * sqrtf(size);
    int widest = 0;
    for (int axis = 1; axis < 6; axis++)
        if (extent[axis] > extent[widest]) widest = axis;
    return widest;
}

static int by_key(const void *a, const void *b)
{
    const struct item *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return p->texel < q->texel ? -1 : p->texel > q->texel;
}

// Halves regions, not texels: all but the last one are full.
static void divide(const struct radiosity_map *map, struct item *items, size_t count)
{
    const size_t regions = radiosity_region_count((uint32_t)count);
    if (regions < 2) {
        for (size_t i = 0; i < count; i++) items[i].key = 0.0f;
        qsort(items, count, sizeof *items, by_key); // neighbours of a chart are near in memory
        return;
    }
    const int axis = widest_axis(map, items, count);
    for (size_t i = 0; i < count; i++) items[i].key = coordinate(map, items[i].texel, axis);
    qsort(items, count, sizeof *items, by_key);
    const size_t low = regions / 2 * RADIOSITY_REGION;
    divide(map, items, low);
    divide(map, items + low, count - low);
}

uint32_t *radiosity_regions(const struct radiosity_map *map)
{
    const size_t count = map->texel_count;
    struct item *items = host_alloc(map->host, count, sizeof *items);
    uint32_t *order = host_alloc(map->host, count, sizeof *order);
    for (uint32_t i = 0; items && i < count; i++) items[i].texel = i;
    if (items) divide(map, items, count);
    for (size_t i = 0; items && order && i < count; i++) order[i] = items[i].texel;
    if (!items) {
        host_free(map->host, order);
        order = NULL;
    }
    host_free(map->host, items);
    return order;
}
