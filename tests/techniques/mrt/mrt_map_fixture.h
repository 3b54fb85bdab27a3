// Block maps for tests of levels. Failures end the test.
#pragma once

#include "techniques/mrt/level/block_map.h"

enum { MRT_ORIENTATIONS = 24 };

// Numbers the corners of a block's cell in another way (0…23), without moving or mirroring it.
void mrt_turn_block(struct mrt_block *block, int orientation);
// Unit cubes in a plane, columns × rows. `open`: the chance that two neighbours are connected.
// `turned`: each block is turned at random; the openings are the same.
struct mrt_block_map mrt_random_grid(int columns, int rows, float open, bool turned, uint32_t seed);
// The blocks of @maze.
struct mrt_block_map mrt_maze(int blocks, int seed);
// The cylinders of @tunnel.
struct mrt_block_map mrt_tunnel(int pieces, int seed);
// Straight cylinders of the same kind along z, of which every second one is turned around, so that
// begins meet begins and ends meet ends.
struct mrt_block_map mrt_pipes(int count);
