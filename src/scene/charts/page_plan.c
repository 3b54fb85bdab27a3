// First fit: instances in the order of their places, each on the first page that has room for all
// of its charts. Instances whose parts share a texel stay together.
#include "scene/charts/page_plan.h"

#include "scene/charts/atlas.h"
#include "scene/charts/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct group {
    uint64_t places; // of its charts, gutters included
    int instance;    // the first one
    uint32_t members, texels;
    uint32_t first, count; // in the items
};

struct page {
    struct atlas atlas;
    uint64_t free; // places
};

struct planning {
    const struct charts *charts;
    const struct scene *scene;
    uint32_t side;
    uint32_t *parent;     // [instances] of the same group; the first one: itself
    uint32_t *places;     // [charts]
    struct group *groups; // [group_count] the largest first
    uint32_t group_count;
    struct pack_item *items; // [charts] group by group
    uint8_t *drawn;          // grids of a group
    struct atlas before;     // of a page
    struct page **pages;     // [group_count]
    struct page_plan *plan;
};

// ---- groups

static uint32_t root_of(struct planning *p, uint32_t instance)
{
    while (p->parent[instance] != instance)
        instance = p->parent[instance] = p->parent[p->parent[instance]];
    return instance;
}

static void unite(struct planning *p, int a, int b)
{
    const uint32_t x = root_of(p, (uint32_t)a), y = root_of(p, (uint32_t)b);
    p->parent[x > y ? x : y] = x < y ? x : y;
}

static void find_parents(struct planning *p)
{
    const struct charts *charts = p->charts;
    for (uint32_t i = 0; i < (uint32_t)p->scene->instance_count; i++) p->parent[i] = i;
    for (uint32_t t = 0; t < charts->triangle_count; t++)
        unite(p, charts->charts[charts->triangles[t].chart].instance,
              charts->triangles[t].instance);
}

static uint32_t chart_of_place(const struct charts *charts, size_t place)
{
    const uint32_t texel = charts->owner[place];
    return texel == CHART_NONE ? CHART_NONE
                               : charts->triangles[charts->texels[texel].triangle].chart;
}

static void count_places(struct planning *p)
{
    const size_t all = (size_t)p->charts->width * p->charts->height;
    for (size_t i = 0; i < all; i++) {
        const uint32_t chart = chart_of_place(p->charts, i);
        if (chart != CHART_NONE) p->places[chart]++;
    }
}

static int compare_groups(const void *a, const void *b)
{
    const struct group *p = a, *q = b;
    if (p->places != q->places) return p->places > q->places ? -1 : 1;
    return p->instance < q->instance ? -1 : p->instance > q->instance;
}

// number: [instances] the group of a parent.
static void add_groups(struct planning *p, uint32_t *number)
{
    const struct charts *charts = p->charts;
    const uint32_t instances = (uint32_t)p->scene->instance_count;
    for (uint32_t i = 0; i < instances; i++) p->groups[i].instance = (int)i;
    for (uint32_t i = 0; i < instances; i++) p->groups[root_of(p, i)].members++;
    for (uint32_t c = 0; c < charts->count; c++) {
        struct group *group = &p->groups[root_of(p, (uint32_t)charts->charts[c].instance)];
        group->places += p->places[c];
        group->texels += charts->charts[c].texel_count;
        group->count++;
    }
    qsort(p->groups, instances, sizeof *p->groups, compare_groups);
    while (p->group_count < instances && p->groups[p->group_count].count > 0) {
        struct group *group = &p->groups[p->group_count];
        number[group->instance] = p->group_count++;
    }
    for (uint32_t c = 0; c < charts->count; c++)
        p->items[c] =
            pack_item_of(charts, c, number[root_of(p, (uint32_t)charts->charts[c].instance)]);
    pack_sort(p->items, charts->count);
    for (uint32_t g = 0, first = 0; g < p->group_count; first += p->groups[g++].count)
        p->groups[g].first = first;
}

static bool find_groups(struct planning *p)
{
    struct host *host = p->charts->host;
    const size_t instances = (size_t)p->scene->instance_count;
    uint32_t *number = host_alloc(host, instances, sizeof *number);
    p->parent = host_alloc(host, instances, sizeof *p->parent);
    p->places = host_alloc(host, p->charts->count, sizeof *p->places);
    p->groups = host_alloc(host, instances, sizeof *p->groups);
    p->items = host_alloc(host, p->charts->count, sizeof *p->items);
    const bool ok = number && p->parent && p->places && p->groups && p->items;
    if (ok) {
        find_parents(p);
        count_places(p);
        add_groups(p, number);
    }
    host_free(host, number);
    return ok;
}

// ---- grids

static size_t rectangle_of(const struct chart *chart)
{
    return (size_t)chart->width * chart->height;
}

static size_t rectangles_of(const struct planning *p, const struct group *group)
{
    size_t sum = 0;
    for (uint32_t i = 0; i < group->count; i++)
        sum += rectangle_of(&p->charts->charts[p->items[group->first + i].chart]);
    return sum;
}

// The texels of a chart's rectangle that it covers, in its orientation in the atlas.
static void draw(const struct planning *p, uint32_t index, uint8_t *taken)
{
    const struct chart *chart = &p->charts->charts[index];
    for (uint32_t y = 0; y < chart->height; y++)
        for (uint32_t x = 0; x < chart->width; x++)
            taken[(size_t)y * chart->width + x] =
                chart_of_place(p->charts,
                               (size_t)(chart->y + y) * p->charts->width + chart->x + x) == index;
}

static void draw_group(const struct planning *p, const struct group *group)
{
    uint8_t *taken = p->drawn;
    for (uint32_t i = 0; i < group->count; i++) {
        const uint32_t chart = p->items[group->first + i].chart;
        draw(p, chart, taken);
        taken += rectangle_of(&p->charts->charts[chart]);
    }
}

// ---- places

// before: gets the atlas as it was, if it is changed; NULL: it is not wanted. *placed: charts that
// were. False: not all of the group's.
static bool place_group(const struct planning *p, const struct group *group, uint32_t page,
                        struct atlas *atlas, struct atlas *before, uint32_t *placed)
{
    uint8_t *taken = p->drawn;
    for (*placed = 0; *placed < group->count; ++*placed) {
        const uint32_t index = p->items[group->first + *placed].chart;
        const struct chart *chart = &p->charts->charts[index];
        const struct footprint_grid grid = { taken, chart->width, chart->height };
        struct atlas_place place = { .top = UINT32_MAX };
        atlas_find(atlas, &grid, 0, &place);
        if (place.top == UINT32_MAX) return false;
        if (*placed == 0 && before && group->count > 1) atlas_copy(before, atlas);
        atlas_take(atlas, &grid, &place);
        p->plan->spots[index] = (struct page_spot){ page, place.x, place.y };
        taken += rectangle_of(chart);
    }
    return true;
}

static bool fits_on(struct planning *p, const struct group *group, uint32_t index)
{
    struct page *page = p->pages[index];
    uint32_t placed;
    if (page->free < group->places) return false;
    if (place_group(p, group, index, &page->atlas, &p->before, &placed)) {
        page->free -= group->places;
        return true;
    }
    if (placed > 0) atlas_copy(&page->atlas, &p->before);
    return false;
}

static bool add_page(struct planning *p)
{
    struct page *page = host_alloc(p->charts->host, 1, sizeof *page);
    if (!page) return false;
    p->pages[p->plan->page_count++] = page;
    page->free = (uint64_t)p->side * p->side;
    return atlas_init(&page->atlas, p->charts->host, p->side, p->side);
}

// ---- an instance that is too large

static bool fits_alone(const struct planning *p, const struct group *group, uint32_t side)
{
    struct atlas atlas;
    uint32_t placed;
    if ((uint64_t)side * side < group->places || !atlas_init(&atlas, p->charts->host, side, side))
        return false;
    const bool fits = place_group(p, group, 0, &atlas, NULL, &placed);
    atlas_finish(&atlas);
    return fits;
}

// The least page that takes the group, if one does.
static uint32_t enough_side(const struct planning *p, const struct group *group)
{
    uint32_t low = p->side / CHART_SIDE_MULTIPLE, high = low;
    do {
        if (high * CHART_SIDE_MULTIPLE >= CHART_MAX_SIDE) return 0;
        low = high;
        high = high * 2;
        if (high * CHART_SIDE_MULTIPLE > CHART_MAX_SIDE)
            high = CHART_MAX_SIDE / CHART_SIDE_MULTIPLE;
    } while (!fits_alone(p, group, high * CHART_SIDE_MULTIPLE));
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (fits_alone(p, group, middle * CHART_SIDE_MULTIPLE))
            high = middle;
        else
            low = middle;
    }
    return high * CHART_SIDE_MULTIPLE;
}

// The group that needs the largest page. *enough: its side; 0: none is large enough.
static const struct group *find_largest(const struct planning *p, const struct group *first,
                                        uint32_t *enough)
{
    const struct group *largest = first;
    draw_group(p, first);
    *enough = enough_side(p, first);
    for (uint32_t g = 0; g<p->group_count && * enough> 0; g++) {
        const struct group *group = &p->groups[g];
        draw_group(p, group);
        if (fits_alone(p, group, *enough)) continue;
        largest = group;
        *enough = enough_side(p, group);
    }
    return largest;
}

// A lower density shrinks gutters less than texels.
static const double LESS = 0.95;

static bool refuse(const struct planning *p, const struct group *first)
{
    uint32_t enough;
    const struct group *group = find_largest(p, first, &enough);
    const char *name = p->scene->nodes[p->scene->instances[group->instance].node].name;
    char shared[64] = "", remedy[96] = "divide its mesh";
    if (group->members > 1)
        snprintf(shared, sizeof shared, ", and %u that share texels with it,", group->members - 1);
    if (enough > 0)
        snprintf(remedy, sizeof remedy, "a page of %u, or density=%.3g, would do", enough,
                 LESS * (double)p->charts->texels_per_m * p->side / enough);
    return host_fail(p->charts->host, FAIL_MEMORY,
                     "light map of %s: instance %d (%s)%s does not fit on a page of %ux%u: %u "
                     "texels; %s",
                     p->scene->name, group->instance, name ? name : "", shared, p->side, p->side,
                     group->texels, remedy);
}

// ---- all

static bool place_all(struct planning *p)
{
    for (uint32_t g = 0; g < p->group_count; g++) {
        const struct group *group = &p->groups[g];
        uint32_t page = 0;
        draw_group(p, group);
        while (page < p->plan->page_count && !fits_on(p, group, page)) page++;
        if (page < p->plan->page_count) continue;
        if (!add_page(p)) return false;
        if (!fits_on(p, group, page)) return refuse(p, group);
    }
    return true;
}

static bool allocate(struct planning *p)
{
    struct host *host = p->charts->host;
    size_t most = 0;
    for (uint32_t g = 0; g < p->group_count; g++) {
        const size_t size = rectangles_of(p, &p->groups[g]);
        if (size > most) most = size;
    }
    p->drawn = host_alloc(host, most, 1);
    p->pages = host_alloc(host, p->group_count, sizeof *p->pages);
    p->plan->spots = host_alloc(host, p->charts->count, sizeof *p->plan->spots);
    return p->drawn && p->pages && p->plan->spots && atlas_init(&p->before, host, p->side, p->side);
}

static void planning_finish(struct planning *p)
{
    struct host *host = p->charts->host;
    for (uint32_t i = 0; i < p->plan->page_count; i++) {
        atlas_finish(&p->pages[i]->atlas);
        host_free(host, p->pages[i]);
    }
    atlas_finish(&p->before);
    host_free(host, p->pages);
    host_free(host, p->drawn);
    host_free(host, p->parent);
    host_free(host, p->places);
    host_free(host, p->groups);
    host_free(host, p->items);
}

bool page_plan_init(struct page_plan *out, const struct charts *charts, const struct scene *scene,
                    uint32_t side)
{
    struct planning p = { .charts = charts, .scene = scene, .side = side, .plan = out };
    *out = (struct page_plan){ .host = charts->host };
    const bool ok = find_groups(&p) && allocate(&p) && place_all(&p);
    planning_finish(&p);
    if (!ok) page_plan_finish(out);
    return ok;
}

void page_plan_finish(struct page_plan *plan)
{
    if (plan->host) host_free(plan->host, plan->spots);
    *plan = (struct page_plan){ 0 };
}
