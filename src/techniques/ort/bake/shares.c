#include "techniques/ort/bake/shares.h"

#include "techniques/ort/bake/stages.h"

#include "bake/plan.h"

static size_t table_width(const struct ort_map *map)
{
    return 2 * (size_t)map->width - 1;
}

static size_t table_size(const struct ort_map *map)
{
    return table_width(map) * (2 * (size_t)map->height - 1);
}

size_t ort_shares_bytes(const struct ort_map *map)
{
    return table_size(map) * sizeof(uint16_t);
}

bool ort_shares_init(struct ort_shares *out, const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    const struct ort_map *map = &scene->map;
    *out = (struct ort_shares){ .host = task->host,
                                .map = map,
                                .group = UINT32_MAX,
                                .count = ort_offset_count(map, &scene->options) };
    if (!scene->kernel) return true;
    out->region_at = host_alloc(task->host, table_size(map), sizeof *out->region_at);
    out->leads_nearby = host_alloc(task->host, out->count, sizeof *out->leads_nearby);
    return out->region_at && out->leads_nearby;
}

void ort_shares_finish(struct ort_shares *shares)
{
    if (!shares->host) return;
    host_free(shares->host, shares->region_at);
    host_free(shares->host, shares->leads_nearby);
    *shares = (struct ort_shares){ 0 };
}

static uint16_t *place_in_table(const struct ort_shares *s, int64_t x, int64_t y)
{
    const size_t column = (size_t)(x + s->map->width - 1);
    const size_t row = (size_t)(y + s->map->height - 1);
    return s->region_at + row * table_width(s->map) + column;
}

bool ort_shares_select(struct ort_shares *s, const struct bake_task *task, uint32_t group)
{
    struct ort_regions regions;
    if (!s->region_at || s->group == group) return true;
    if (!ort_find_regions(task, group, &regions)) return false;
    for (uint32_t k = 0; k < regions.count; k++)
        for (uint32_t i = regions.first[k]; i < regions.first[k + 1]; i++) {
            const struct ort_span span = regions.spans[i];
            for (int32_t x = span.x0; x <= span.x1; x++)
                *place_in_table(s, x, span.y) = (uint16_t)k;
        }
    ort_regions_finish(&regions);
    s->group = group;
    s->offsets =
        (const int32_t *)bake_task_input(task, ORT_OFFSETS)->data + 2 * (size_t)group * s->count;
    return true;
}

struct visit {
    const struct ort_shares *shares;
    const struct ort_transfer *transfer;
    const struct ort_receiver *to;
    struct ort_place place; // of the receiver
    float *const *weight;
};

static uint32_t region_of(const struct visit *v, uint32_t from)
{
    const struct ort_place at = ort_place_of(v->shares->map, from);
    return *place_in_table(v->shares, (int64_t)at.x - v->place.x, (int64_t)at.y - v->place.y);
}

// The light of the region is that of one texel, which has to be a neighbour, too.
static bool leads_nearby(const struct visit *v, uint32_t region)
{
    const int32_t *offset = v->shares->offsets + 2 * (size_t)region;
    const uint32_t at = ort_texel_at(v->shares->map, v->place, offset[0], offset[1]);
    float share[3];
    if (at == CHART_NONE || !(ort_texel_area(&v->transfer->texels, at) > 0.0f)) return false;
    ort_transfer_scattered(v->transfer, v->to, at, share);
    return share[0] + share[1] + share[2] > 0.0f;
}

static void add_share(void *user, uint32_t from)
{
    const struct visit *v = user;
    const float area = ort_texel_area(&v->transfer->texels, from);
    float share[3];
    ort_transfer_scattered(v->transfer, v->to, from, share);
    if (!(share[0] + share[1] + share[2] > 0.0f)) return;
    const uint32_t region = region_of(v, from);
    if (!v->shares->leads_nearby[region]) return;
    for (int c = 0; c < 3; c++) v->weight[c][region] += share[c] * area;
}

void ort_shares_add(struct ort_shares *shares, const struct ort_transfer *transfer,
                    const struct ort_receiver *to, float *const weight[3])
{
    const struct ort_scene *scene = transfer->texels.scene;
    struct visit v = { shares, transfer, to, ort_place_of(shares->map, to->texel), weight };
    for (uint32_t k = 0; k < shares->count; k++) shares->leads_nearby[k] = leads_nearby(&v, k);
    ort_near_visit(&scene->near, chart_texel_of(&scene->map.charts, to->texel)->centroid, add_share,
                   &v);
}
