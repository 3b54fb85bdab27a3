// Probes of a level (Loos 2015, section 3.5.5): p³ in the cell of each block, at (i + ½)/p of its
// edges, in x, then y, then z. Between them irradiance is interpolated in bricks of (p + 2)³
// texels, whose border has the probes beyond the block's openings.
#pragma once

#include "techniques/mrt/level/block_map.h"

enum { MRT_PROBE_VALUES = 9 }; // SH coefficients of irradiance by normal

static inline int mrt_probes_of_block(int p)
{
    return p * p * p;
}

static inline int mrt_brick_texels(int p)
{
    return (p + 2) * (p + 2) * (p + 2);
}

vec3s mrt_probe_cell(int p, int i);                                    // in [−½, ½]³
vec3s mrt_probe_position(const struct mrt_block *block, int p, int i); // world
// The rotation nearest to the warp's Jacobian in the middle of the cell: from cell to world.
mat3s mrt_block_rotation(const struct mrt_block *block);
// The probe of the level at texel i of a block's brick. Beyond a wall: the nearest of the block.
int mrt_probe_of_brick_texel(const struct mrt_block_map *map, int p, int block, int i);
