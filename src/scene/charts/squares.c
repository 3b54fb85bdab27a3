#include "scene/charts/squares.h"

#include <stdlib.h>

struct item {
    struct chart_texel texel;
    uint32_t before; // its number
};

static int compare(uint32_t a, uint32_t b)
{
    return a < b ? -1 : a > b;
}

// Bits of x and y in turns.
static uint32_t morton(const struct chart_texel *t)
{
    uint32_t code = 0;
    for (uint32_t bit = 0; 1u << bit < CHART_SQUARE; bit++)
        code |= (t->x >> bit & 1) << 2 * bit | (t->y >> bit & 1) << (2 * bit + 1);
    return code;
}

static int by_square(const void *a, const void *b)
{
    const struct chart_texel *p = &((const struct item *)a)->texel,
                             *q = &((const struct item *)b)->texel;
    const int rows = compare(p->y / CHART_SQUARE, q->y / CHART_SQUARE);
    const int columns = compare(p->x / CHART_SQUARE, q->x / CHART_SQUARE);
    if (rows != 0) return rows;
    if (columns != 0) return columns;
    return compare(morton(p), morton(q));
}

// Backs follow: they are in the order of their fronts.
static void order_chart(struct charts *charts, const struct chart *chart, struct item *items,
                        uint32_t *number)
{
    const uint32_t first = chart->first_texel;
    for (uint32_t i = 0; i < chart->texel_count; i++)
        items[i] = (struct item){ charts->texels[first + i], first + i };
    qsort(items, chart->texel_count, sizeof *items, by_square);
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        charts->texels[first + i] = items[i].texel;
        number[items[i].before] = first + i;
    }
}

bool charts_order_by_squares(struct charts *charts)
{
    struct item *items = host_alloc(charts->host, charts->texel_count, sizeof *items);
    uint32_t *number = host_alloc(charts->host, charts->texel_count, sizeof *number);
    const bool ok = items && number;
    for (uint32_t i = 0; ok && i < charts->count; i++)
        order_chart(charts, &charts->charts[i], items, number);
    const size_t places = (size_t)charts->width * charts->height;
    for (size_t i = 0; ok && i < places; i++)
        if (charts->owner[i] != CHART_NONE) charts->owner[i] = number[charts->owner[i]];
    host_free(charts->host, items);
    host_free(charts->host, number);
    return ok;
}
