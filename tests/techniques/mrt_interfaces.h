// Interface operators of a block dictionary, for tests. Failures end the test.
#pragma once

#include "techniques/mrt_fixture.h"

#include "techniques/mrt/dictionary/cube_shapes.h"
#include "techniques/mrt/dictionary/interface.h"
#include "techniques/mrt/dictionary/response.h"

struct mrt_interface_options {
    enum mrt_maze maze;
    int resolution, k_b, k_rlf, k_r, rounds;
    struct mrt_lightfield lightfield;
};

struct mrt_interfaces {
    struct mrt_interface_options options;
    struct matrix_f64 f[MRT_MAX_CUBES];
    struct mrt_transfer transfer[MRT_MAX_CUBES];
    struct matrix_f32 implicit;             // texels of mrt_cube_left × (openings · k_b)
    double *scale;                          // openings · k_b: equation 4.1
    struct matrix_f32 h_lf;                 // samples × (openings · k_b)
    struct matrix_f32 h_rlf;                // samples × k_rlf
    double *sigma;                          // k_rlf
    struct matrix_f32 r_b;                  // k_rlf × (openings · k_b)
    struct matrix_f32 r_turn[MRT_TURNS_3D]; // k_rlf × k_rlf
    struct mrt_response response;
};

void mrt_interfaces_build(const struct mrt_interface_options *options, struct mrt_interfaces *out);
void mrt_interfaces_finish(struct mrt_interfaces *interfaces);
// The first column of an opening of a dictionary cube in h_lf and r_b.
size_t mrt_interfaces_column(const struct mrt_interfaces *interfaces, int cube, int face);
