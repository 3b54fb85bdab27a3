#include "techniques/ort/ort_map.h"

#include "techniques/ort/bins.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_CHARTS = 1 << 20 };

static enum charts_coordinates coordinates_of(const struct ort_options *options)
{
    static const enum charts_coordinates OF[] = { CHARTS_TEXCOORD_0_OR_1, CHARTS_TEXCOORD_0,
                                                  CHARTS_TEXCOORD_1, CHARTS_NO_TEXCOORD };
    return OF[options->coordinates];
}

bool ort_charts(const struct scene_pose *statics, const void *options, struct host *host,
                const struct charts_search *begin, struct charts *out)
{
    const struct ort_options *o = options;
    const struct charts_wish wish = { .technique = "ort",
                                      .texels = (uint32_t)o->texels,
                                      .begin = begin,
                                      .density = o->density,
                                      .most_charts = MOST_CHARTS,
                                      .coordinates = coordinates_of(o) };
    return charts_init_wanted(out, host, statics, &wish);
}

static bool make_plane(struct ort_map *map)
{
    const size_t places = (size_t)map->width * map->height;
    map->texel_at = host_alloc(map->host, places, sizeof *map->texel_at);
    if (!map->texel_at) return false;
    memset(map->texel_at, 0xff, places * sizeof *map->texel_at);
    for (uint32_t i = 0; i < map->texel_count; i++) {
        const struct ort_place at = ort_place_of(map, i);
        map->texel_at[(size_t)at.y * map->width + at.x] = i;
    }
    return true;
}

// ---- groups

struct ranked {
    uint32_t chart, texels;
};

static int compare(const void *a, const void *b)
{
    const struct ranked *p = a, *q = b;
    if (p->texels != q->texels) return p->texels > q->texels ? -1 : 1;
    return p->chart < q->chart ? -1 : p->chart > q->chart;
}

// The group of each chart: its rank by texels, or the last.
static uint8_t *rank_charts(const struct ort_map *map)
{
    const struct charts *charts = &map->charts;
    uint8_t *group = host_alloc(map->host, charts->count, sizeof *group);
    struct ranked *ranked = host_alloc(map->host, charts->count, sizeof *ranked);
    const bool ok = group && ranked;
    for (uint32_t c = 0; ok && c < charts->count; c++)
        ranked[c] = (struct ranked){ c, charts->charts[c].texel_count };
    if (ok && charts->count > 0) qsort(ranked, charts->count, sizeof *ranked, compare);
    for (uint32_t k = 0; ok && k < charts->count; k++)
        group[ranked[k].chart] = (uint8_t)(k < map->group_count ? k : map->group_count - 1);
    host_free(map->host, ranked);
    if (ok) return group;
    host_free(map->host, group);
    return NULL;
}

static void fill_groups(struct ort_map *map, const uint8_t *of_chart)
{
    for (uint32_t i = 0; i < map->texel_count; i++) {
        map->group_of[i] = of_chart[chart_triangle_of(&map->charts, i)->chart];
        map->first[map->group_of[i] + 1]++;
    }
    for (uint32_t g = 0; g < map->group_count; g++) map->first[g + 1] += map->first[g];
    for (uint32_t i = 0; i < map->texel_count; i++)
        map->members[map->first[map->group_of[i]]++] = i;
    for (uint32_t g = map->group_count; g > 0; g--) map->first[g] = map->first[g - 1];
    map->first[0] = 0;
}

static bool make_groups(struct ort_map *map, uint32_t most)
{
    const uint32_t charts = map->charts.count > 0 ? map->charts.count : 1;
    map->group_count = charts < most ? charts : most;
    map->group_of = host_alloc(map->host, map->texel_count, sizeof *map->group_of);
    map->first = host_alloc(map->host, (size_t)map->group_count + 1, sizeof *map->first);
    map->members = host_alloc(map->host, map->texel_count, sizeof *map->members);
    uint8_t *of_chart = rank_charts(map);
    const bool ok = map->group_of && map->first && map->members && of_chart;
    if (ok) fill_groups(map, of_chart);
    host_free(map->host, of_chart);
    return ok;
}

// ----

// Images of bins and of light, which has a margin, are within the limits of all devices.
static bool check_side(const struct ort_map *map, const char *side, uint32_t texels)
{
    const uint32_t most = ORT_MAX_MAP_SIDE - 2 * ORT_MARGIN;
    return texels <= most ||
           host_fail(map->host, FAIL_UNSUPPORTED,
                     "ort: the light map has a %s of %u texels, above %u; give fewer texels", side,
                     texels, most);
}

bool ort_map_init(struct ort_map *out, struct host *host, const struct scene_pose *pose,
                  const struct ort_options *options)
{
    *out = (struct ort_map){ .host = host };
    if (!ort_charts(pose, options, host, NULL, &out->charts)) return false;
    out->texel_count = out->charts.side_texel_count;
    out->width = out->charts.width;
    out->height = charts_sides(&out->charts) * out->charts.height;
    if (check_side(out, "width", out->width) && check_side(out, "height", out->height) &&
        make_plane(out) && make_groups(out, (uint32_t)options->local))
        return true;
    ort_map_finish(out);
    return false;
}

void ort_map_finish(struct ort_map *map)
{
    if (!map->host) return;
    charts_finish(&map->charts);
    host_free(map->host, map->texel_at);
    host_free(map->host, map->group_of);
    host_free(map->host, map->first);
    host_free(map->host, map->members);
    *map = (struct ort_map){ 0 };
}
