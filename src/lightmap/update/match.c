// Which instances and charts of two scenes are equal, by the hashes of their records.
#include "lightmap/update/update.h"

#include <stdlib.h>
#include <string.h>

static int compare_hashes(const struct hash128 *a, const struct hash128 *b)
{
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return a->low < b->low ? -1 : a->low > b->low;
}

// A table of entries by hash; those of one hash are in the order of their indices.
struct entry {
    struct hash128 key;
    uint32_t index;
    bool used;
};

static int compare_entries(const void *x, const void *y)
{
    const struct entry *a = x, *b = y;
    const int order = compare_hashes(&a->key, &b->key);
    return order != 0 ? order : a->index < b->index ? -1 : a->index > b->index;
}

// The first entry of the hash; `count`: there is none.
static uint32_t find(const struct entry *entries, uint32_t count, const struct hash128 *key)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (compare_hashes(&entries[middle].key, key) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && compare_hashes(&entries[low].key, key) == 0 ? low : count;
}

// ---- instances

static struct entry *instance_table(struct host *host, const struct lightmap_record *was,
                                    uint32_t *count)
{
    struct entry *entries = host_alloc(host, was->instance_count, sizeof *entries);
    *count = 0;
    for (uint32_t i = 0; entries && i < was->instance_count; i++)
        if (was->instances[i].triangles > 0)
            entries[(*count)++] = (struct entry){ was->instances[i].shape, i, false };
    if (entries) qsort(entries, *count, sizeof *entries, compare_entries);
    return entries;
}

// Takes the first unused instance of the same shape; with `surface` one with that surface, too.
static void match_instance(struct update_match *m, const struct lightmap_record *was,
                           const struct record_instance *now, uint32_t index, bool surface,
                           struct entry *entries, uint32_t count)
{
    if (now->triangles == 0 || m->was[index] != UPDATE_NONE) return;
    for (uint32_t e = find(entries, count, &now->shape);
         e < count && hash128_same(entries[e].key, now->shape); e++) {
        const struct record_instance *old = &was->instances[entries[e].index];
        const bool same = hash128_same(old->surface, now->surface);
        if (entries[e].used || (surface && !same)) continue;
        entries[e].used = true;
        m->was[index] = entries[e].index;
        m->same[index] = same;
        return;
    }
}

static bool match_instances(struct update_match *m, const struct lightmap_record *was,
                            const struct lightmap_record *now)
{
    uint32_t count;
    struct entry *entries = instance_table(m->host, was, &count);
    if (!entries) return false;
    for (uint32_t i = 0; i < now->instance_count; i++) m->was[i] = UPDATE_NONE;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < now->instance_count; i++)
            match_instance(m, was, &now->instances[i], i, pass == 0, entries, count);
    for (uint32_t i = 0; i < now->instance_count; i++)
        m->changed += now->instances[i].triangles > 0 && !m->same[i];
    // A moved instance is both gone and added.
    uint32_t gone = 0, added = 0;
    for (uint32_t i = 0; i < now->instance_count; i++)
        added += now->instances[i].triangles > 0 && m->was[i] == UPDATE_NONE;
    for (uint32_t e = 0; e < count; e++) {
        m->gone[entries[e].index] = !entries[e].used;
        gone += !entries[e].used;
    }
    if (gone > added) m->changed += gone - added;
    host_free(m->host, entries);
    return true;
}

// ---- lights

bool update_same_light(const struct world_light *a, const struct world_light *b)
{
    return a->type == b->type &&
           memcmp(a->position.raw, b->position.raw, sizeof a->position.raw) == 0 &&
           memcmp(a->direction.raw, b->direction.raw, sizeof a->direction.raw) == 0 &&
           memcmp(a->intensity.raw, b->intensity.raw, sizeof a->intensity.raw) == 0 &&
           memcmp(&a->cos_inner, &b->cos_inner, sizeof a->cos_inner) == 0 &&
           memcmp(&a->cos_outer, &b->cos_outer, sizeof a->cos_outer) == 0 &&
           memcmp(&a->range_m, &b->range_m, sizeof a->range_m) == 0;
}

static bool same_lights(const struct lightmap_record *a, const struct lightmap_record *b)
{
    if (a->light_count != b->light_count) return false;
    for (uint32_t i = 0; i < a->light_count; i++)
        if (!update_same_light(&a->lights[i], &b->lights[i])) return false;
    return true;
}

// ---- charts

// By place in the chart. grid: of its size, all UPDATE_NONE before and after.
static void match_texels(struct update_match *m, const struct lightmap_record *was,
                         const struct record_chart *old, const struct lightmap_record *now,
                         const struct record_chart *chart, uint32_t *grid)
{
    for (uint32_t k = 0; k < old->texel_count; k++) {
        const struct record_place at = was->places[old->first_texel + k];
        if (at.x < old->width && at.y < old->height) grid[at.y * old->width + at.x] = k;
    }
    for (uint32_t i = 0; i < chart->texel_count; i++) {
        const struct record_place at = now->places[chart->first_texel + i];
        const uint32_t k = grid[at.y * chart->width + at.x];
        if (k == UPDATE_NONE) continue;
        m->row_was[chart->first_texel + i] = old->first_texel + k;
        if (chart->first_back != CHART_NONE)
            m->row_was[chart->first_back + i] = old->first_back + k;
    }
    memset(grid, 0xff, (size_t)chart->width * chart->height * sizeof *grid);
}

static bool is_same_grid(const struct record_chart *a, const struct record_chart *b)
{
    return a->width == b->width && a->height == b->height &&
           (a->first_back == CHART_NONE) == (b->first_back == CHART_NONE);
}

static uint32_t *create_grid(struct host *host, const struct lightmap_record *now)
{
    size_t most = 1;
    for (uint32_t i = 0; i < now->chart_count; i++) {
        const size_t size = (size_t)now->charts[i].width * now->charts[i].height;
        if (size > most) most = size;
    }
    uint32_t *grid = host_alloc(host, most, sizeof *grid);
    if (grid) memset(grid, 0xff, most * sizeof *grid);
    return grid;
}

static void match_chart(struct update_match *m, const struct lightmap_record *was,
                        const struct lightmap_record *now, const struct record_chart *chart,
                        struct entry *entries, uint32_t *grid)
{
    for (uint32_t e = find(entries, was->chart_count, &chart->key);
         e < was->chart_count && hash128_same(entries[e].key, chart->key); e++) {
        const struct record_chart *old = &was->charts[entries[e].index];
        if (entries[e].used || !is_same_grid(old, chart)) continue;
        entries[e].used = true;
        match_texels(m, was, old, now, chart, grid);
        return;
    }
}

static bool match_charts(struct update_match *m, const struct lightmap_record *was,
                         const struct lightmap_record *now)
{
    struct entry *entries = host_alloc(m->host, was->chart_count, sizeof *entries);
    uint32_t *grid = create_grid(m->host, now);
    const bool ok = entries && grid;
    for (uint32_t i = 0; ok && i < was->chart_count; i++)
        entries[i] = (struct entry){ was->charts[i].key, i, false };
    if (ok) qsort(entries, was->chart_count, sizeof *entries, compare_entries);
    for (uint32_t i = 0; ok && i < now->chart_count; i++)
        match_chart(m, was, now, &now->charts[i], entries, grid);
    host_free(m->host, entries);
    host_free(m->host, grid);
    return ok;
}

// The scene may have more equal instances at one place than the earlier one.
static void drop_unmatched(struct update_match *m, const struct charts *charts)
{
    for (uint32_t t = 0; t < charts->triangle_count; t++) {
        const struct chart *chart = &charts->charts[charts->triangles[t].chart];
        if (m->was[charts->triangles[t].instance] != UPDATE_NONE) continue;
        for (uint32_t i = 0; i < chart->texel_count; i++) {
            m->row_was[chart->first_texel + i] = UPDATE_NONE;
            if (chart->first_back != CHART_NONE) m->row_was[chart->first_back + i] = UPDATE_NONE;
        }
        t = chart->first_triangle + chart->triangle_count - 1;
    }
}

// ---- the surroundings of changes

enum { MOST_BOXES = 64 };

// The last box is the union of all that have no room.
static void add_box(struct update_match *m, struct box3 box)
{
    const float size = glms_vec3_max(box3_size(box));
    const vec3s edge = vec3_of(size, size, size);
    const struct box3 near = { glms_vec3_sub(box.min, edge), glms_vec3_add(box.max, edge) };
    const bool full = m->near_count == MOST_BOXES;
    const uint32_t i = full ? MOST_BOXES - 1 : m->near_count++;
    m->near[i] = full ? box3_union(m->near[i], near) : near;
    m->boxes[i] = full ? box3_union(m->boxes[i], box) : box;
}

static bool find_boxes(struct update_match *m, const struct lightmap_record *was,
                       const struct lightmap_record *now)
{
    m->near = host_alloc(m->host, MOST_BOXES, sizeof *m->near);
    m->boxes = host_alloc(m->host, MOST_BOXES, sizeof *m->boxes);
    if (!m->near || !m->boxes) return false;
    for (uint32_t i = 0; i < now->instance_count; i++)
        if (now->instances[i].triangles > 0 && !m->same[i]) add_box(m, now->instances[i].bounds);
    for (uint32_t i = 0; i < was->instance_count; i++)
        if (m->gone[i]) add_box(m, was->instances[i].bounds);
    return true;
}

static bool is_in(const struct box3 *box, vec3s position)
{
    return box3_intersects(*box, (struct box3){ position, position });
}

// Beside a small object light changes from texel to texel. A large box may be most of the scene.
enum { SMALL_SHARE = 50 };

static bool find_small_boxes(struct update_match *m, const struct charts *charts)
{
    m->near_is_small = host_alloc(m->host, MOST_BOXES, sizeof *m->near_is_small);
    for (uint32_t b = 0; m->near_is_small && b < m->near_count; b++) {
        uint32_t inside = 0;
        for (uint32_t i = 0; i < charts->texel_count; i++)
            inside += is_in(&m->near[b], charts->texels[i].position);
        m->near_is_small[b] = inside <= charts->texel_count / SMALL_SHARE;
    }
    return m->near_is_small;
}

enum update_near update_near_change(const struct update_match *m, vec3s position)
{
    enum update_near near = UPDATE_FAR;
    for (uint32_t i = 0; i < m->near_count && near != UPDATE_BESIDE; i++)
        if (is_in(&m->near[i], position)) near = m->near_is_small[i] ? UPDATE_BESIDE : UPDATE_NEAR;
    return near;
}

// ---- all

bool update_match_init(struct update_match *out, struct host *host,
                       const struct lightmap_record *was, const struct lightmap_record *now,
                       const struct charts *charts)
{
    *out = (struct update_match){ .host = host, .same_lights = same_lights(was, now) };
    out->was = host_alloc(host, now->instance_count, sizeof *out->was);
    out->same = host_alloc(host, now->instance_count, sizeof *out->same);
    out->gone = host_alloc(host, was->instance_count, sizeof *out->gone);
    out->row_was = host_alloc(host, now->row_count, sizeof *out->row_was);
    bool ok = out->was && out->same && out->gone && out->row_was;
    for (uint32_t i = 0; ok && i < now->row_count; i++) out->row_was[i] = UPDATE_NONE;
    ok = ok && match_instances(out, was, now) && match_charts(out, was, now) &&
         find_boxes(out, was, now) && find_small_boxes(out, charts);
    if (ok) drop_unmatched(out, charts);
    for (uint32_t i = 0; ok && i < now->row_count; i++)
        out->without += out->row_was[i] == UPDATE_NONE;
    if (!ok) update_match_finish(out);
    return ok;
}

void update_match_finish(struct update_match *m)
{
    if (!m->host) return;
    host_free(m->host, m->was);
    host_free(m->host, m->same);
    host_free(m->host, m->gone);
    host_free(m->host, m->row_was);
    host_free(m->host, m->near);
    host_free(m->host, m->boxes);
    host_free(m->host, m->near_is_small);
    *m = (struct update_match){ 0 };
}
