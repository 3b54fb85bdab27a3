// solver=cpu: indirect light of a level from its direct light, on all cores (Loos 2015, section
// 3.6.3, steps 2 to 5).
#pragma once

#include "techniques/mrt/level/level.h"

struct mrt_solver {
    struct host *host;
    const struct mrt_level *level; // borrowed
    int face_texels;               // of a wall, rounded up to lanes
    // Per shape of the dictionary: k_b rows over the padded texels of its walls.
    float *t_db[MRT_MAX_CUBES], *u_b[MRT_MAX_CUBES];
    float **t_retraced, **u_retraced; // the same for each of level->retraces
    float *ratios;   // [entries] × 6 n² texels of a cube: mrt_opening_ratios; NULL: all are 1
    float *u_r;      // [walls of all mrt_entered_shape] × k_r × face_texels
    int *cube_texel; // [texels of the level]: padded texel of the shape
    int entered_face[MRT_RESPONSES][CUBE_FACES]; // by mrt_response_of and wall
    int *entered_texel;                          // [MRT_RESPONSES] × [6 walls] × texels of a wall
    float *light; // [texels of a closed cube or a tube, padded] × 3 colours for each block
    float *b, *r; // [blocks] × k_b × 3, [entries] × k_r × 3
};

bool mrt_solver_init(struct host *host, const struct mrt_level *level, struct mrt_solver *solver);
void mrt_solver_finish(struct mrt_solver *solver); // accepts zero

// Radiosity (lm/m²) to indirect irradiance (lux) without further bounces, RGB at each texel of the
// level. The same bits whatever the number of threads.
void mrt_solve(struct mrt_solver *solver, const float *radiosity, float *irradiance);
