// Rays in the world, followed through the cells of blocks.
#pragma once

#include "techniques/mrt/level/block_map.h"
#include "techniques/mrt/level/wall.h"

struct mrt_cell_ray {
    int block;
    vec3s position, direction; // in the cell
};

// The ray in the cell of a block, from the nearest point of the cell. False where the warp has no
// inverse there.
bool mrt_cell_ray_enter(const struct mrt_block_map *map, int block, vec3s from, vec3s way,
                        struct mrt_cell_ray *ray);
// The wall or opening where it ends in the cell, and the point in the world.
vec3s mrt_cell_ray_end(const struct mrt_block_map *map, int resolution,
                       const struct mrt_cell_ray *ray, struct mrt_hit *hit);

// The frame whose third axis is the normal.
mat3s mrt_frame_of_normal(vec3s normal);
