#include "techniques/radiosity/radiosity_map.h"

#include "scene/charts/squares.h"

#include <string.h>

// ---- clusters

// Numbers the squares of one side of a chart, in the order in which its texels meet them. `square`:
// [2 · chart->width × chart->height]. part: NULL: all 0.
static void number_squares(struct radiosity_map *map, const struct chart *chart, uint32_t edge,
                           uint32_t first, const uint8_t *part, uint32_t *square)
{
    const uint32_t across = (chart->width + edge - 1) / edge;
    memset(square, 0xff, 2 * (size_t)chart->width * chart->height * sizeof *square);
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        const struct chart_texel *t = &map->charts.texels[chart->first_texel + i];
        const uint32_t column = (t->x - chart->x) / edge, row = (t->y - chart->y) / edge;
        uint32_t *at = &square[2 * ((size_t)row * across + column) + (part ? part[first + i] : 0)];
        if (*at == CHART_NONE) *at = map->cluster_count++;
        map->cluster_of[first + i] = *at;
    }
}

static bool make_clusters(struct radiosity_map *map, uint32_t edge, const uint8_t *part)
{
    const struct charts *charts = &map->charts;
    size_t most = 0;
    for (uint32_t c = 0; c < charts->count; c++) {
        const size_t size = (size_t)charts->charts[c].width * charts->charts[c].height;
        if (size > most) most = size;
    }
    uint32_t *square = host_alloc(map->host, most, 2 * sizeof *square);
    if (!square) return false;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        number_squares(map, chart, edge, chart->first_texel, part, square);
        if (chart->first_back == CHART_NONE) continue;
        number_squares(map, chart, edge, chart->first_back, part, square);
    }
    host_free(map->host, square);
    return true;
}

static void list_members(struct radiosity_map *map)
{
    memset(map->first, 0, ((size_t)map->cluster_count + 1) * sizeof *map->first);
    for (uint32_t i = 0; i < map->texel_count; i++) map->first[map->cluster_of[i] + 1]++;
    for (uint32_t c = 0; c < map->cluster_count; c++) map->first[c + 1] += map->first[c];
    for (uint32_t i = 0; i < map->texel_count; i++)
        map->members[map->first[map->cluster_of[i]]++] = i;
    for (uint32_t c = map->cluster_count; c > 0; c--) map->first[c] = map->first[c - 1];
    map->first[0] = 0;
}

static struct radiosity_place place_of(const struct radiosity_map *map, uint32_t cluster)
{
    struct radiosity_place sum = { 0 };
    float area = 0.0f;
    for (uint32_t m = map->first[cluster]; m < map->first[cluster + 1]; m++) {
        const struct chart_texel *t = chart_texel_of(&map->charts, map->members[m]);
        const vec3s normal = chart_texel_normal(&map->charts, map->members[m]);
        sum.position = glms_vec3_muladds(t->position, t->area_m2, sum.position);
        sum.normal = glms_vec3_muladds(normal, t->area_m2, sum.normal);
        area += t->area_m2;
    }
    if (area > 0.0f) sum.position = glms_vec3_divs(sum.position, area);
    sum.normal = vec3_unit(sum.normal);
    return sum;
}

static bool number_as_tree(struct radiosity_map *map)
{
    const uint32_t count = map->cluster_count;
    struct radiosity_place *places = host_alloc(map->host, count, sizeof *places);
    uint32_t *order = host_alloc(map->host, count, sizeof *order);
    uint32_t *number = host_alloc(map->host, count, sizeof *number);
    bool ok = places && order && number;
    for (uint32_t c = 0; ok && c < count; c++) places[c] = place_of(map, c);
    ok = ok && radiosity_tree_init(&map->tree, map->host, places, count, order);
    for (uint32_t c = 0; ok && c < count; c++) number[order[c]] = c;
    for (uint32_t i = 0; ok && i < map->texel_count; i++)
        map->cluster_of[i] = number[map->cluster_of[i]];
    host_free(map->host, places);
    host_free(map->host, order);
    host_free(map->host, number);
    return ok;
}

static bool make_hierarchy(struct radiosity_map *map)
{
    map->first = host_alloc(map->host, (size_t)map->cluster_count + 1, sizeof *map->first);
    map->members = host_alloc(map->host, map->texel_count, sizeof *map->members);
    if (!map->first || !map->members) return false;
    list_members(map);
    if (!number_as_tree(map)) return false;
    list_members(map);
    return true;
}

// ----

bool radiosity_charts(const struct scene_pose *statics, const void *options, struct host *host,
                      const struct charts_search *begin, struct charts *out)
{
    const struct radiosity_options *o = options;
    const struct charts_wish wish = { .technique = "radiosity",
                                      .texels = (uint32_t)o->texels,
                                      .begin = begin,
                                      .density = o->density,
                                      .most_charts = RADIOSITY_MAX_CLUSTERS / 2 };
    return charts_init_wanted(out, host, statics, &wish) && charts_order_by_squares(out);
}

static bool refuse(const struct radiosity_map *map)
{
    return host_fail(map->host, FAIL_MEMORY,
                     "radiosity: %u sources of light, at most %d; the scene has too many small "
                     "charts",
                     map->cluster_count, RADIOSITY_MAX_CLUSTERS / 2);
}

enum { MOST_EDGE = 32 };

// Clusters, larger ones than wanted where there would be too many: each may have two parts.
static bool make_sources(struct radiosity_map *map, const struct radiosity_options *options)
{
    for (map->edge = (uint32_t)options->cluster;; map->edge++) {
        map->cluster_count = 0;
        if (!make_clusters(map, map->edge, NULL)) return false;
        if (map->cluster_count <= RADIOSITY_MAX_CLUSTERS / 2) return make_hierarchy(map);
        if (map->edge >= MOST_EDGE) return refuse(map);
    }
}

bool radiosity_map_init(struct radiosity_map *out, struct host *host, const struct scene_pose *pose,
                        const struct radiosity_options *options)
{
    *out = (struct radiosity_map){ .host = host };
    bool ok = radiosity_charts(pose, options, host, NULL, &out->charts);
    out->texel_count = out->charts.side_texel_count;
    out->cluster_of = host_alloc(host, out->texel_count, sizeof *out->cluster_of);
    ok = ok && out->cluster_of && make_sources(out, options);
    if (!ok) radiosity_map_finish(out);
    return ok;
}

static void finish_sources(struct radiosity_map *map)
{
    host_free(map->host, map->first);
    host_free(map->host, map->members);
    radiosity_tree_finish(&map->tree);
    map->first = map->members = NULL;
    map->cluster_count = 0;
}

bool radiosity_map_subdivide(struct radiosity_map *map, const uint8_t *part)
{
    finish_sources(map);
    return make_clusters(map, map->edge, part) && make_hierarchy(map);
}

void radiosity_map_finish(struct radiosity_map *map)
{
    if (!map->host) return;
    charts_finish(&map->charts);
    finish_sources(map);
    host_free(map->host, map->cluster_of);
    *map = (struct radiosity_map){ 0 };
}
