#include "techniques/ort/levels.h"

#include "techniques/ort/bake/regions.h"

#include <math.h>

// ---- levels of offsets

static double deviation(int level)
{
    return sqrt((pow(9.0, level) - 1.0) / 8.0);
}

static uint8_t level_of(double places)
{
    const double wanted = 0.5 * sqrt(places / GLM_PI);
    int level = wanted < 0.5 ? 0 : 1;
    while (level > 0 && level < ORT_LEVELS - 1 &&
           wanted * wanted > deviation(level) * deviation(level + 1))
        level++;
    return (uint8_t)level;
}

static uint32_t places_of(const struct ort_regions *regions, uint32_t region)
{
    uint32_t sum = 0;
    for (uint32_t i = regions->first[region]; i < regions->first[region + 1]; i++)
        sum += (uint32_t)(regions->spans[i].x1 - regions->spans[i].x0 + 1);
    return sum;
}

bool ort_find_levels(const struct ort_maps *maps, uint8_t *level)
{
    const struct ort_map *map = maps->map;
    struct ort_offset *offsets = host_alloc(map->host, maps->offsets, sizeof *offsets);
    bool ok = offsets != NULL;
    for (uint32_t first = 0; ok && first < maps->count; first += maps->offsets) {
        struct ort_regions regions;
        for (uint32_t k = 0; k < maps->offsets; k++) {
            const int32_t *offset = maps->offset + 2 * (size_t)(first + k);
            offsets[k] = (struct ort_offset){ offset[0], offset[1] };
        }
        ok = ort_regions_init(&regions, map->host, offsets, maps->offsets, map->width, map->height);
        for (uint32_t k = 0; ok && k < maps->offsets; k++)
            level[first + k] = level_of(places_of(&regions, k));
        ort_regions_finish(&regions);
    }
    host_free(map->host, offsets);
    return ok;
}

// ---- steps between linked texels

enum { LEFT = 0, RIGHT = 8, ABOVE = 16, BELOW = 24, MOST = 255 };

static bool is_linked(const struct ort_map *map, const uint8_t *links, size_t place, uint8_t link)
{
    const uint32_t texel = map->texel_at[place];
    return texel != CHART_NONE && (links[texel] & link);
}

static uint32_t one_more(uint32_t steps, int side)
{
    const uint32_t count = steps >> side & MOST;
    return (count < MOST ? count + 1 : MOST) << side;
}

static uint32_t *step_at(const struct ort_map *map, uint32_t *steps, size_t place)
{
    return &steps[place % map->width * map->height + place / map->width];
}

void ort_find_steps(const struct ort_map *map, const uint8_t *links, uint32_t *steps)
{
    const size_t width = map->width, count = width * map->height;
    for (size_t i = 0; i < count; i++) {
        uint32_t *at = step_at(map, steps, i);
        *at = 0;
        if (i % width > 0 && is_linked(map, links, i - 1, ORT_LINK_X))
            *at |= one_more(*step_at(map, steps, i - 1), LEFT);
        if (i >= width && is_linked(map, links, i - width, ORT_LINK_Y))
            *at |= one_more(*step_at(map, steps, i - width), ABOVE);
    }
    for (size_t i = count; i-- > 0;) {
        uint32_t *at = step_at(map, steps, i);
        if (i % width + 1 < width && is_linked(map, links, i, ORT_LINK_X))
            *at |= one_more(*step_at(map, steps, i + 1), RIGHT);
        if (i + width < count && is_linked(map, links, i, ORT_LINK_Y))
            *at |= one_more(*step_at(map, steps, i + width), BELOW);
    }
}
