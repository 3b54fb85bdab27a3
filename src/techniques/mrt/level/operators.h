// The operators of a block dictionary, as levels use them (Loos 2015, table 3.1). Borrowed from
// whoever has computed or loaded them.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/cube_shapes.h"
#include "techniques/mrt/dictionary/interface.h"

struct mrt_cube_matrices {
    struct matrix_f32 t_db;            // k_b × texels of the cube
    struct matrix_f32 u_b;             // texels × k_b
    struct matrix_f32 r_b[CUBE_FACES]; // k_rlf × k_b: lightfield at each opening
};

struct mrt_operators {
    enum mrt_maze maze;
    int resolution; // texels along an edge of a face
    int k_b, k_rlf, k_r;
    struct mrt_cube_matrices cube[MRT_MAX_CUBES];
    struct matrix_f32 turn[MRT_TURNS_3D]; // k_rlf × k_rlf; those of the plane alone in MRT_MAZE_2D
    struct matrix_f32 t_r;                // k_r × k_rlf
    struct matrix_f32 u_r;                // texels of mrt_cube_entered × k_r
};
