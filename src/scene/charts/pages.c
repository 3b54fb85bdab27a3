// Pages lie side by side, and row by row, in an atlas that is about square.
#include "scene/charts/page_plan.h"

#include <string.h>

static uint32_t round_up(uint32_t side)
{
    return (side + CHART_SIDE_MULTIPLE - 1) / CHART_SIDE_MULTIPLE * CHART_SIDE_MULTIPLE;
}

static uint32_t last_height(const struct charts *charts, const struct page_plan *plan)
{
    uint32_t height = 0;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct page_spot *spot = &plan->spots[c];
        const uint32_t end = spot->y + charts->charts[c].height;
        if (spot->page + 1 == plan->page_count && end > height) height = end;
    }
    return round_up(height);
}

static bool refuse(const struct charts *charts, const struct scene *scene, uint32_t count,
                   uint32_t side)
{
    const uint32_t most = CHART_MAX_SIDE / side;
    return host_fail(charts->host, FAIL_MEMORY,
                     "light map of %s: it needs %u pages of %ux%u, of which %u are possible; take "
                     "smaller pages or lower the density",
                     scene->name, count, side, side, most * most);
}

// The size of the atlas, and its pages.
static bool arrange(struct charts *out, const struct scene *scene, const struct page_plan *plan,
                    uint32_t side)
{
    const uint32_t count = plan->page_count, height = last_height(out, plan);
    uint32_t columns = 1;
    while (columns * columns < count) columns++;
    const uint32_t rows = (count + columns - 1) / columns;
    if (columns * side > CHART_MAX_SIDE) return refuse(out, scene, count, side);
    out->pages = host_alloc(out->host, count, sizeof *out->pages);
    if (!out->pages) return false;
    for (uint32_t i = 0; i < count; i++)
        out->pages[i] = (struct chart_page){ .x = i % columns * side,
                                             .y = i / columns * side,
                                             .width = side,
                                             .height = i + 1 < count ? side : height };
    out->page_count = count;
    out->width = columns * side;
    out->height = (rows - 1) * side + (count % columns == 1 || columns == 1 ? height : side);
    return true;
}

// Texels of a chart and places that they own, in an atlas of the width before.
static void move_places(struct charts *charts, const struct chart *chart, const uint32_t *owner,
                        uint32_t width, uint32_t x0, uint32_t y0)
{
    for (uint32_t y = 0; y < chart->height; y++)
        for (uint32_t x = 0; x < chart->width; x++) {
            const uint32_t texel = owner[(size_t)(y0 + y) * width + x0 + x];
            if (texel == CHART_NONE || texel - chart->first_texel >= chart->texel_count) continue;
            charts->owner[(size_t)(chart->y + y) * charts->width + chart->x + x] = texel;
        }
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        struct chart_texel *texel = &charts->texels[chart->first_texel + i];
        texel->x = texel->x - x0 + chart->x;
        texel->y = texel->y - y0 + chart->y;
    }
}

// Rounding moves no place over the border of a texel.
static void move_triangles(struct charts *charts, const struct chart *chart, uint32_t x0,
                           uint32_t y0)
{
    for (uint32_t i = 0; i < chart->triangle_count; i++) {
        struct chart_triangle *t = &charts->triangles[chart->first_triangle + i];
        for (int k = 0; k < 3; k++) {
            t->place[k].x = (float)((double)t->place[k].x - x0 + chart->x);
            t->place[k].y = (float)((double)t->place[k].y - y0 + chart->y);
        }
    }
}

static void move(struct charts *charts, uint32_t index, const struct page_spot *spot,
                 const uint32_t *owner, uint32_t width)
{
    struct chart *chart = &charts->charts[index];
    const uint32_t x = chart->x, y = chart->y;
    chart->page = spot->page;
    chart->x = charts->pages[spot->page].x + spot->x;
    chart->y = charts->pages[spot->page].y + spot->y;
    move_places(charts, chart, owner, width, x, y);
    move_triangles(charts, chart, x, y);
}

static bool move_all(struct charts *charts, const struct scene *scene, const struct page_plan *plan,
                     uint32_t side)
{
    uint32_t *owner = charts->owner;
    const uint32_t width = charts->width;
    if (!arrange(charts, scene, plan, side)) return false;
    const size_t places = (size_t)charts->width * charts->height;
    charts->owner = host_alloc(charts->host, places, sizeof *owner);
    if (charts->owner) {
        memset(charts->owner, 0xff, places * sizeof *owner);
        for (uint32_t c = 0; c < charts->count; c++) move(charts, c, &plan->spots[c], owner, width);
    }
    host_free(charts->host, owner);
    return charts->owner;
}

bool charts_set_pages(struct charts *charts, const struct scene *scene, uint32_t side)
{
    struct page_plan plan;
    if (charts->width <= side && charts->height <= side) return true;
    const bool ok =
        page_plan_init(&plan, charts, scene, side) && move_all(charts, scene, &plan, side);
    page_plan_finish(&plan);
    return ok;
}
