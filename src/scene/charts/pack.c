// The largest charts first, each at the turn and place with the lowest top; gaps between charts
// are filled by smaller ones.
#include "scene/charts/pack.h"

#include "scene/charts/atlas.h"

#include <math.h>
#include <stdlib.h>

struct packing {
    struct charts *charts;
    struct grown *grown;
    uint32_t *order; // [count]
    uint8_t *spare;  // of the largest rectangle
    uint8_t *drawn;  // grids of all charts
    size_t *first;   // [count] of a chart's, in `drawn`
    struct atlas atlas;
};

static uint32_t round_up(double side)
{
    const double rounded = CHART_SIDE_MULTIPLE * ceil(side / CHART_SIDE_MULTIPLE);
    return (uint32_t)fmin(rounded, (double)CHART_MAX_SIDE);
}

// ---- rectangles

struct extent {
    double places;    // of all charts' rectangles or footprints
    uint32_t longest; // side
    size_t largest;   // rectangle
};

static void add_extent(struct extent *extent, const struct chart *chart, double places)
{
    const size_t size = (size_t)chart->width * chart->height;
    const uint32_t side = chart->width > chart->height ? chart->width : chart->height;
    extent->places += places;
    if (size > extent->largest) extent->largest = size;
    if (side > extent->longest) extent->longest = side;
}

static struct extent start_rectangles(const struct packing *p)
{
    struct extent extent = { 0 };
    for (uint32_t i = 0; i < p->charts->count; i++) {
        const struct grown_chart *from = &p->grown->charts[i];
        struct chart *chart = &p->charts->charts[i];
        chart->width = (from->single_texel ? 0 : (uint32_t)from->width) + 1 + 2 * CHART_GUTTER;
        chart->height = (from->single_texel ? 0 : (uint32_t)from->height) + 1 + 2 * CHART_GUTTER;
        add_extent(&extent, chart, (double)chart->width * chart->height);
    }
    return extent;
}

// Half of the places of an atlas are in footprints, at least.
static double most_side(const struct extent *extent)
{
    return 2.0 * sqrt(extent->places) + 2.0 * extent->longest + 2.0 * CHART_SIDE_MULTIPLE;
}

// To multiples of the step between floats at the atlas' far end, so that a place plus a whole
// number is exact.
static void round_places(const struct packing *p, const struct extent *extent)
{
    double side = 1.0;
    while (side < most_side(extent) && side < CHART_MAX_SIDE) side *= 2.0;
    const double steps = ldexp(1.0, 24) / side;
    const struct grown_chart *last = &p->grown->charts[p->grown->count - 1];
    for (uint32_t t = 0; t < last->first_triangle + last->triangle_count; t++)
        for (int k = 0; k < 6; k++) {
            double *at = &p->grown->place[t][k / 2][k % 2];
            *at = rint(*at * steps) / steps;
        }
}

// Unturned.
static struct footprint_grid grid_of(const struct packing *p, uint32_t index)
{
    const struct chart *chart = &p->charts->charts[index];
    const bool across = chart->turns % 2 == 1;
    return (struct footprint_grid){ &p->drawn[p->first[index]],
                                    across ? chart->height : chart->width,
                                    across ? chart->width : chart->height };
}

static struct extent draw_all(const struct packing *p)
{
    struct extent extent = { 0 };
    size_t end = 0;
    for (uint32_t i = 0; i < p->charts->count; i++) {
        struct chart *chart = &p->charts->charts[i];
        p->first[i] = end;
        struct footprint_grid grid = grid_of(p, i);
        footprint_draw(&grid, p->spare, p->grown, &p->grown->charts[i]);
        const size_t size = (size_t)grid.width * grid.height;
        double places = 0.0;
        for (size_t k = 0; k < size; k++) places += (double)grid.taken[k];
        chart->width = grid.width;
        chart->height = grid.height;
        add_extent(&extent, chart, places);
        end += size;
    }
    return extent;
}

// ---- order

static int compare_items(const void *a, const void *b)
{
    const struct pack_item *p = a, *q = b;
    if (p->group != q->group) return p->group < q->group ? -1 : 1;
    if (p->longer != q->longer) return p->longer > q->longer ? -1 : 1;
    if (p->shorter != q->shorter) return p->shorter > q->shorter ? -1 : 1;
    return p->chart < q->chart ? -1 : p->chart > q->chart;
}

struct pack_item pack_item_of(const struct charts *charts, uint32_t chart, uint32_t group)
{
    const uint32_t w = charts->charts[chart].width, h = charts->charts[chart].height;
    return (struct pack_item){ group, w > h ? w : h, w > h ? h : w, chart };
}

void pack_sort(struct pack_item *items, uint32_t count)
{
    qsort(items, count, sizeof *items, compare_items);
}

static bool find_order(struct packing *p)
{
    const uint32_t count = p->charts->count;
    struct pack_item *items = host_alloc(p->charts->host, count, sizeof *items);
    if (!items) return false;
    for (uint32_t i = 0; i < count; i++) items[i] = pack_item_of(p->charts, i, 0);
    pack_sort(items, count);
    for (uint32_t i = 0; i < count; i++) p->order[i] = items[i].chart;
    host_free(p->charts->host, items);
    return true;
}

// ---- places

static uint32_t turn_count(const struct footprint_grid *grid)
{
    for (size_t i = 0; i < (size_t)grid->width * grid->height; i++)
        if (!grid->taken[i]) return 4;
    return grid->width == grid->height ? 1 : 2;
}

// False: it is above the room.
static bool place_chart(struct packing *p, uint32_t index)
{
    struct chart *chart = &p->charts->charts[index];
    const struct footprint_grid grid = grid_of(p, index);
    struct atlas_place best = { .top = UINT32_MAX };
    const uint32_t turns = turn_count(&grid);
    for (uint32_t turn = 0; turn < turns; turn++) atlas_find(&p->atlas, &grid, turn, &best);
    if (best.top == UINT32_MAX) return false;
    atlas_take(&p->atlas, &grid, &best);
    chart->x = best.x;
    chart->y = best.y;
    chart->turns = best.turns;
    chart->width = best.turns % 2 == 0 ? grid.width : grid.height;
    chart->height = best.turns % 2 == 0 ? grid.height : grid.width;
    if (chart->y + chart->height > p->charts->height) p->charts->height = chart->y + chart->height;
    return true;
}

// False without memory. Otherwise the atlas has a height: CHART_MAX_SIDE where there was no room.
static bool place_all(struct packing *p, const struct extent *extent)
{
    struct charts *charts = p->charts;
    const double height = extent->places / charts->width + most_side(extent);
    if (!atlas_init(&p->atlas, charts->host, charts->width, round_up(height))) return false;
    bool placed = true;
    charts->height = 0;
    for (uint32_t i = 0; i < charts->count && placed; i++) placed = place_chart(p, p->order[i]);
    charts->height = placed ? round_up(charts->height) : CHART_MAX_SIDE;
    atlas_finish(&p->atlas);
    return true;
}

// Few charts leave large gaps at most widths: several are tried.
enum { WIDTHS = 16, WIDTHS_TIMES_CHARTS = 4096 };

static bool place_at_best_width(struct packing *p, const struct extent *extent)
{
    struct charts *charts = p->charts;
    const uint32_t first = charts->width;
    uint32_t best = first, tries = WIDTHS_TIMES_CHARTS / charts->count;
    uint64_t least = UINT64_MAX;
    if (tries > WIDTHS) tries = WIDTHS;
    for (uint32_t i = 0; i < tries; i++) {
        charts->width = first + i * CHART_SIDE_MULTIPLE;
        if (charts->width > CHART_MAX_SIDE) break;
        if (!place_all(p, extent)) return false;
        const uint64_t places = (uint64_t)charts->width * charts->height;
        if (places >= least) continue;
        least = places;
        best = charts->width;
    }
    charts->width = best;
    return place_all(p, extent);
}

// Gaps that are left, in shares of the footprints.
static const double GAPS = 0.04;

static bool allocate(struct packing *p, const struct extent *rectangles)
{
    struct host *host = p->charts->host;
    p->spare = host_alloc(host, rectangles->largest, 1);
    p->drawn = host_alloc(host, (size_t)rectangles->places, 1);
    p->first = host_alloc(host, p->charts->count, sizeof *p->first);
    p->order = host_alloc(host, p->charts->count, sizeof *p->order);
    return p->spare && p->drawn && p->first && p->order;
}

// The size of an atlas that the charts nearly fill.
static void set_size(struct charts *charts, const struct extent *extent)
{
    const double places = (1.0 + GAPS) * extent->places;
    charts->width = round_up(fmax(sqrt(places), (double)extent->longest));
    charts->height = round_up(places / charts->width);
}

static const double MOST_DRAWN = 1 << 30;

static bool pack(struct packing *p, uint32_t max_texels, bool *packed)
{
    struct charts *charts = p->charts;
    struct extent extent = start_rectangles(p);
    set_size(charts, &extent);
    if (extent.places > MOST_DRAWN) return true;
    if (!allocate(p, &extent)) return false;
    round_places(p, &extent);
    extent = draw_all(p);
    set_size(charts, &extent);
    if (extent.places > (double)max_texels || extent.longest > CHART_MAX_SIDE) return true;
    if (!find_order(p) || !place_at_best_width(p, &extent)) return false;
    *packed = (uint64_t)charts->width * charts->height <= max_texels;
    return true;
}

bool pack_charts(struct charts *charts, struct grown *grown, uint32_t max_texels, bool *packed)
{
    struct packing p = { .charts = charts, .grown = grown };
    *packed = false;
    const bool ok = pack(&p, max_texels, packed);
    host_free(charts->host, p.spare);
    host_free(charts->host, p.drawn);
    host_free(charts->host, p.first);
    host_free(charts->host, p.order);
    return ok;
}

void pack_place(const struct chart *chart, const double place[2], double out[2])
{
    const double width = chart->turns % 2 == 0 ? chart->width : chart->height;
    const double height = chart->turns % 2 == 0 ? chart->height : chart->width;
    const double x[4] = { place[0], height - place[1], width - place[0], place[1] };
    const double y[4] = { place[1], place[0], height - place[1], width - place[0] };
    out[0] = chart->x + x[chart->turns];
    out[1] = chart->y + y[chart->turns];
}
