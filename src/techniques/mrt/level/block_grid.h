// A grid over all blocks; each cell lists the blocks whose bounds, with a margin, touch it.
#pragma once

#include "techniques/mrt/level/block_map.h"

struct mrt_block_list {
    uint32_t first, count; // of the candidates
};

struct mrt_block_grid {
    struct host *host;
    const struct mrt_block_map *map;
    vec3s origin_m;
    float cell_m;
    int cells[3];
    struct mrt_block_list *lists; // [z][y][x]
    uint32_t *candidates;         // the block nearest to a cell's middle is the first of its list
    size_t candidate_count;
};

// The map must outlive it. cells: along the longest side. margin: of a block's bounds on each side,
// in its own size. false: out of memory.
bool mrt_block_grid_init(struct host *host, const struct mrt_block_map *map, float margin,
                         int cells, struct mrt_block_grid *out);
void mrt_block_grid_finish(struct mrt_block_grid *grid); // accepts zero

// The shortest distance from the middle of a block to that of a wall, twice, in metres.
float mrt_shortest_edge(const struct mrt_block_map *map);

// Places of a cell up to here from its middle are in the block, with its walls.
#define MRT_IN_CELL (0.5f + 1e-3f)
bool mrt_is_in_a_block(const struct mrt_block_grid *grid, vec3s point);

// An empty list outside of the grid.
struct mrt_block_list mrt_blocks_near(const struct mrt_block_grid *grid, vec3s point);
