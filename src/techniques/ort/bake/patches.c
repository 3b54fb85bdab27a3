#include "techniques/ort/bake/patches.h"

#include "trace/trace_scene.h"

#include <math.h>
#include <stdlib.h>

enum { AXES = 6 }; // of position and normal

// Normals count as lengths: opposite ones are this part of the scene's diagonal apart.
static const float NORMAL_LENGTH = 0.125f;

struct item {
    float at[AXES];
    float key; // along the axis of the sort
    uint32_t texel;
};

static int compare(const void *a, const void *b)
{
    const struct item *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return p->texel < q->texel ? -1 : p->texel > q->texel;
}

static int longest_axis(const struct item *items, size_t count)
{
    int longest = 0;
    float most = -1.0f;
    for (int a = 0; a < AXES; a++) {
        float low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < count; i++) {
            low = fminf(low, items[i].at[a]);
            high = fmaxf(high, items[i].at[a]);
        }
        if (high - low > most) {
            most = high - low;
            longest = a;
        }
    }
    return longest;
}

// Divides the items evenly between `patches` patches from `first` on. Its depth is the logarithm of
// their number.
static void subdivide(struct item *items, size_t count, uint32_t first, uint32_t patches,
                      uint32_t *patch_of)
{
    if (patches == 1) {
        for (size_t i = 0; i < count; i++) patch_of[items[i].texel] = first;
        return;
    }
    const int axis = longest_axis(items, count);
    for (size_t i = 0; i < count; i++) items[i].key = items[i].at[axis];
    qsort(items, count, sizeof *items, compare);
    const uint32_t low = patches / 2;
    const size_t middle = count * low / patches;
    subdivide(items, middle, first, low, patch_of);
    subdivide(items + middle, count - middle, first + low, patches - low, patch_of);
}

static void fill_items(const struct ort_map *map, struct item *items)
{
    struct box3 box = box3_empty();
    for (uint32_t i = 0; i < map->texel_count; i++)
        box = box3_add_point(box, chart_texel_of(&map->charts, i)->position);
    const float length = NORMAL_LENGTH * 0.5f * glms_vec3_norm(box3_size(box));
    for (uint32_t i = 0; i < map->texel_count; i++) {
        const vec3s position = chart_texel_of(&map->charts, i)->position;
        const vec3s normal = chart_texel_normal(&map->charts, i);
        items[i].texel = i;
        for (int a = 0; a < 3; a++) {
            items[i].at[a] = position.raw[a];
            items[i].at[3 + a] = length * normal.raw[a];
        }
    }
}

// The texel nearest to the mean of a patch's positions.
static uint32_t middle_of(const struct item *items, size_t count)
{
    float mean[3] = { 0 }, least = INFINITY;
    uint32_t middle = items[0].texel;
    for (size_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) mean[a] += items[i].at[a] / (float)count;
    for (size_t i = 0; i < count; i++) {
        float square = 0.0f;
        for (int a = 0; a < 3; a++)
            square += (items[i].at[a] - mean[a]) * (items[i].at[a] - mean[a]);
        if (square >= least) continue;
        least = square;
        middle = items[i].texel;
    }
    return middle;
}

// A point above the surface of a texel.
static vec3s point_above(const struct ort_map *map, const struct trace_scene *trace, uint32_t texel)
{
    const struct chart_triangle *of = chart_triangle_of(&map->charts, texel);
    const float reach = trace_mesh_of(trace, of->instance)->facets[of->triangle].reach;
    return glms_vec3_muladds(chart_texel_normal(&map->charts, texel), reach,
                             chart_texel_of(&map->charts, texel)->position);
}

// Texels that the middle of a patch does not see are the second part of it.
static void split_by_walls(const struct ort_map *map, const struct trace_scene *trace,
                           const struct item *items, uint32_t patches, uint32_t *patch_of)
{
    for (size_t first = 0, end; first < map->texel_count; first = end) {
        const uint32_t patch = patch_of[items[first].texel];
        for (end = first; end < map->texel_count && patch_of[items[end].texel] == patch;) end++;
        const vec3s from = point_above(map, trace, middle_of(items + first, end - first));
        for (size_t i = first; i < end; i++) {
            const vec3s to = point_above(map, trace, items[i].texel);
            if (trace_occluded(trace, from, glms_vec3_sub(to, from), 1.0f))
                patch_of[items[i].texel] += patches;
        }
    }
}

uint32_t *ort_make_patches(const struct ort_map *map, const struct trace_scene *trace)
{
    const uint32_t count = map->texel_count, patches = (ort_patch_count(count) + 1) / 2;
    uint32_t *patch_of = host_alloc(map->host, count, sizeof *patch_of);
    struct item *items = host_alloc(map->host, count, sizeof *items);
    if (patch_of && items && count > 0) {
        fill_items(map, items);
        subdivide(items, count, 0, patches, patch_of);
        split_by_walls(map, trace, items, patches, patch_of);
    }
    const bool ok = items != NULL;
    host_free(map->host, items);
    if (ok) return patch_of;
    host_free(map->host, patch_of);
    return NULL;
}
