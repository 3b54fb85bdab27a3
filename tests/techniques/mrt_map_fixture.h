// Block maps for tests of levels. Failures end the test.
#pragma once

#include "techniques/mrt/level/block_map.h"

enum { MRT_ORIENTATIONS = 24 };

// Numbers the corners of a block's cell in another way (0…23), without moving or mirroring it.
void mrt_turn_block(struct mrt_block *block, int orientation);
// Unit cubes in a plane, columns × rows, each turned at random. `open`: the chance that two
// neighbours are connected.
struct mrt_block_map mrt_random_grid(int columns, int rows, float open, uint32_t seed);
