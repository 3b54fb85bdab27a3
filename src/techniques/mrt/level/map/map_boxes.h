// The blocks of free cells.
#pragma once

#include "techniques/mrt/level/block_map.h"
#include "techniques/mrt/level/map/map_cells.h"

// No block where no cell is free. first: number in the name of the first block.
bool mrt_map_of_cells(struct host *host, const char *what, struct mrt_cells *cells, int first,
                      struct mrt_block_map *map);
