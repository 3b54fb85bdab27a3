// Bases of blocks that are far from cubes (Loos 2015, figure 3.4): the light of L_imp gathered
// again by rays in the block's own proportions, and T_d→b fitted to it (projection.h). L_imp stays
// that of the cube, light through openings is scaled (opening_view.h).
#pragma once

#include "techniques/mrt/dictionary/dictionary.h"
#include "techniques/mrt/level/block_map.h"

// Operators of one cube of the dictionary in one shape, in the order of the cube's texels.
struct mrt_retraced {
    int cube;
    mat3s metric;          // JᵀJ of the warp from the cube's cell, with a trace of 3
    mat3s block_from_cell; // J
    float area;            // of the walls of all its blocks, m²
    struct matrix_f32 u_b, u_vec, t_db;
};

struct mrt_retraces {
    struct host *host;
    struct mrt_retraced *at;
    int count;
    int *of_block; // index in `at`; −1: the dictionary's own bases
};

// The proportions that are traced: those of most wall area, of blocks whose longest edge is at most
// `flattest` times the shortest.
struct mrt_retrace_limits {
    int most; // number of proportions
    float flattest;
    bool openings; // T_d→b is fitted to the light that leaves by them, too
};

// Blocks of equal cube and proportions share their bases; a block that is a cube keeps the
// dictionary's. The warp is taken as that of the block's middle, an affine one.
bool mrt_retraces_init(struct host *host, const struct mrt_block_map *map,
                       const struct mrt_cube_place *places, const struct mrt_dictionary *dictionary,
                       struct mrt_retrace_limits limits, struct mrt_retraces *out);
void mrt_retraces_finish(struct mrt_retraces *retraces); // accepts zero

// Columns: the images in the cell of an orthonormal frame at a wall of the block, whose third axis
// is the wall's normal. frame: that of the wall in the cell.
mat3s mrt_cell_from_wall(mat3s block_from_cell, mat3s frame);
