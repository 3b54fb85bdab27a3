#include "techniques/ort/ort_maps.h"

#include <string.h>

static bool check_offsets(const struct ort_maps *maps)
{
    const int64_t limit[2] = { maps->map->width, maps->map->height };
    for (size_t i = 0; i < 2 * (size_t)maps->count; i++)
        if (maps->offset[i] <= -limit[i % 2] || maps->offset[i] >= limit[i % 2])
            return host_fail(maps->map->host, FAIL_FORMAT,
                             "bake of ort: offset %d beyond the light map", maps->offset[i]);
    return true;
}

bool ort_maps_find(struct ort_maps *out, const struct ort_map *map,
                   const struct ort_options *options, const struct tensors *bake)
{
    const uint64_t n = light_map_rows(map->texel_count), k = ort_offset_count(map, options);
    const uint64_t groups = map->group_count;
    *out = (struct ort_maps){ .map = map, .offsets = (uint32_t)k, .count = (uint32_t)(groups * k) };
    return (out->offset = TENSORS_EXPECT(map->host, bake, ORT_OFFSETS, TENSOR_I32, groups, k, 2)) &&
           (out->weight = TENSORS_EXPECT(map->host, bake, ORT_MAPS, TENSOR_F16, n, k, 3)) &&
           (map->texel_count == 0 || check_offsets(out));
}

static bool has_source(const struct ort_maps *maps, uint32_t k, struct ort_place at)
{
    const int32_t *offset = maps->offset + 2 * (size_t)k;
    return ort_texel_at(maps->map, at, offset[0], offset[1]) != CHART_NONE;
}

bool ort_maps_at(const struct ort_maps *maps, uint32_t k, struct ort_place at, size_t *weight)
{
    const uint32_t texel = ort_texel_at(maps->map, at, 0, 0);
    if (texel == CHART_NONE || maps->map->group_of[texel] != k / maps->offsets) return false;
    *weight = (size_t)(ort_weight(maps, texel, k) - maps->weight);
    return has_source(maps, k, at);
}

bool ort_maps_mask(void *user, uint32_t k, uint8_t *mask)
{
    const struct ort_maps *maps = user;
    const struct ort_map *map = maps->map;
    memset(mask, 0, (size_t)map->width * map->height);
    const uint32_t group = k / maps->offsets;
    for (uint32_t i = map->first[group]; i < map->first[group + 1]; i++) {
        const struct ort_place at = ort_place_of(map, map->members[i]);
        const uint16_t *w = ort_weight(maps, map->members[i], k);
        const bool lit = ((w[0] | w[1] | w[2]) & 0x7fff) != 0;
        if (lit) mask[at.y * (size_t)map->width + at.x] = has_source(maps, k, at);
    }
    return true;
}
