// Memory of operators of blocks with clutter, before rays find them.
#include "techniques/mrt/objects/clutter_operators.h"

#include "techniques/mrt/objects/delta.h"

static bool has_clutter(const struct mrt_clutter *clutter, const struct mrt_block *block)
{
    const struct charts *charts = &clutter->charts;
    const struct box3 box = mrt_bounds_of_block(block);
    for (uint32_t t = 0; t < charts->triangle_count; t++)
        if (box3_intersects(mrt_bounds_of_triangle(&charts->triangles[t]), box)) return true;
    return false;
}

static uint64_t largest_of(const struct matrix_f32 light[MRT_MEASURES])
{
    uint64_t most = 0;
    for (int m = 0; m < MRT_MEASURES; m++) {
        const uint64_t numbers = (uint64_t)light[m].rows * light[m].columns;
        if (numbers > most) most = numbers;
    }
    return most;
}

uint64_t mrt_clutter_numbers(const struct mrt_operators *o, const struct mrt_block_map *map,
                             const struct mrt_clutter *clutter, int *blocks)
{
    uint64_t responses = (uint64_t)o->response_count;
    int opening = 0;
    *blocks = 0;
    for (int b = 0; b < map->count; b++) {
        const bool changed = has_clutter(clutter, &map->blocks[b]);
        *blocks += changed;
        responses += changed; // of its faces
        for (; opening < o->opening_count && o->openings[opening].block == b; opening++)
            responses += changed;
    }
    const uint64_t of_bases = (uint64_t)(o->basis_count + *blocks) * largest_of(o->bases[0].u),
                   of_responses = responses * largest_of(o->responses[0].u);
    return of_bases > of_responses ? of_bases : of_responses;
}
