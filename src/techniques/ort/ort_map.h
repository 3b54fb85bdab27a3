// The light map in texture space: the plane in which offsets are measured. Backs of double-sided
// surfaces lie below the fronts, so that a place has one texel.
#pragma once

#include "scene/charts/charts.h"

#include "techniques/ort/ort_options.h"

struct ort_map {
    struct host *host;
    struct charts charts;
    uint32_t texel_count;   // of both sides
    uint32_t width, height; // of the plane: charts.width, charts_sides() · charts.height
    uint32_t *texel_at;     // [width · height]; CHART_NONE: none, as in gutters
    // Texels whose offsets are the same: those of a large chart, the last ones of all others.
    uint32_t group_count; // at least 1
    uint8_t *group_of;    // [texel_count]
    uint32_t *first;      // [group_count + 1] of the group, in `members`
    uint32_t *members;    // [texel_count] group after group, in ascending order
};

bool ort_charts(const struct scene_pose *statics, const void *options, struct host *host,
                const struct charts_search *begin, struct charts *out);
// ort_map_finish accepts zero.
bool ort_map_init(struct ort_map *out, struct host *host, const struct scene_pose *pose,
                  const struct ort_options *options);
void ort_map_finish(struct ort_map *map);

struct ort_place {
    uint32_t x, y;
};

static inline struct ort_place ort_place_of(const struct ort_map *map, uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(&map->charts, texel);
    return (struct ort_place){ t->x, t->y + (chart_is_back(&map->charts, texel) ? map->charts.height
                                                                                : 0) };
}

// The texel at a place moved by an offset; CHART_NONE: none.
static inline uint32_t ort_texel_at(const struct ort_map *map, struct ort_place place, int32_t dx,
                                    int32_t dy)
{
    const uint32_t x = place.x + (uint32_t)dx, y = place.y + (uint32_t)dy; // below 0: beyond
    return x < map->width && y < map->height ? map->texel_at[(size_t)y * map->width + x]
                                             : CHART_NONE;
}

enum { ORT_MOST_PATCHES = 1024 };

// Patches of a light map, of which half may be empty (bake/patches.h).
static inline uint32_t ort_patch_count(uint32_t texels)
{
    const uint32_t count = 2 * texels;
    return count == 0 ? 1 : count < ORT_MOST_PATCHES ? count : ORT_MOST_PATCHES;
}

// Offsets of each group in a bake: as many as there are, if more are wanted.
static inline uint32_t ort_offset_count(const struct ort_map *map,
                                        const struct ort_options *options)
{
    const uint64_t all = (uint64_t)(2 * map->width - 1) * (2 * map->height - 1);
    if (map->texel_count == 0) return 1;
    return all < (uint64_t)options->offsets ? (uint32_t)all : (uint32_t)options->offsets;
}
