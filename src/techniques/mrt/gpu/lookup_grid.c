// The blocks near each place, for locate.glsl.
#include "techniques/mrt/gpu/upload.h"

#include "techniques/mrt/level/block_grid.h"

// Margin of a block over its bounds: surfaces outside still belong to the nearest block (MRT_BEYOND
// in locate.glsl).
static const float MARGIN = 1.0f;
static const float OFFSET = 0.01f; // of the shortest edge: lookups along the normal

static void set_params(struct mrt_level_params *level, const struct mrt_block_grid *grid,
                       const struct mrt_block_map *map)
{
    level->grid_origin_m = grid->origin_m;
    level->cells_per_m = 1.0f / grid->cell_m;
    level->cells_x = grid->cells[0];
    level->cells_y = grid->cells[1];
    level->cells_z = grid->cells[2];
    level->offset_m = OFFSET * mrt_shortest_edge(map);
}

bool mrt_lookup_grid_upload(struct mrt_runtime *runtime, const struct mrt_block_map *map)
{
    struct mrt_block_grid grid;
    if (!mrt_block_grid_init(runtime->host, map, MARGIN, MRT_LOOKUP_CELLS, &grid)) return false;
    const size_t cells = (size_t)grid.cells[0] * (size_t)grid.cells[1] * (size_t)grid.cells[2];
    set_params(&runtime->level, &grid, map);
    const bool ok = mrt_buffer_of(runtime, "mrt_cells", grid.lists, cells * sizeof *grid.lists) &&
                    mrt_buffer_of(runtime, "mrt_candidates", grid.candidates,
                                  grid.candidate_count * sizeof *grid.candidates);
    mrt_block_grid_finish(&grid);
    return ok;
}
