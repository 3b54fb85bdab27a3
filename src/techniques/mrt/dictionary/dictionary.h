// The dictionary of modular radiance transfer: operators that serve all scenes (Loos 2015, table
// 3.1). dictionary_bake.c computes them, dictionary.c reads them.
//
// Tensors of the bake, n texels of the shape, k_b = modes, k_l = lightfield_modes, k_r =
// response_modes, N openings of the cube in ascending order of their faces; all F32:
//
//     cube/I/U_b        [n, k_b]       irradiance (lux) of each b-coefficient
//     cube/I/T_db       [k_b, n]       b-coefficients of radiosity (lm/m²) at each texel
//     cube/I/L_imp      [n, k_b]       radiosity whose indirect light is U_b
//     cube/I/U_vec      [n, 4, k_b]    irradiance by normal: OHLSH in the frame of mrt_point
//     cube/I/U_bvol     [p³, 9, k_b]   irradiance by normal at probes: SH in the frame of the cube
//     cube/I/R_b        [N, k_l, k_b]  lightfield coefficients at each opening
//     cube/I/sigma_L    [min(n, lights)]  singular values of the direct light of the prior
//     cube/I/sigma_M    [k_d]          those of M = F P S
//     cube/I/checks     [2]            ‖U_mᵀ U_m − I‖, ‖F L_imp − U_b‖ / ‖U_b‖
//     cube/I/R_wall     [W, k_l, k_b]  the same at each closed face that may have holes, but for
//     the
//                                      light of that face
//     interface/R_turn  [3 or 6, k_l, k_l]  propagation to the exits, by enum mrt_turn
//     interface/R_hole  [16, k_l, k_l] what each part of an interface lets pass (hole_bake.c)
//     interface/T_r     [e·k_r, k_l]   r-coefficients of lightfield coefficients
//     interface/U_r     [e·m, k_r]     irradiance at the m texels of mrt_entered_shape
//     interface/U_rvec  [e·m, 4, k_r]  the same by normal
//     interface/U_rvol  [e·p³, 9, k_r] the same at probes, in the frame of the interface
//
// Tubes are named tube/I; e is 1 for cubes and 3 for tubes, one part for each mrt_entered_shape
// below the other.
//
// A lightfield coefficient is with respect to H_rlf = U Σ, which is not kept.
#pragma once

#include "bake/bake.h"
#include "core/linalg.h"
#include "core/option.h"

#include "techniques/mrt/dictionary/cube_shapes.h"
#include "techniques/mrt/dictionary/interface.h"

struct mrt_dictionary_options {
#define OPTION OPTION_FIELD
#include "techniques/mrt/dictionary/dictionary_options.def"
#undef OPTION
};

// Without a level MRT_MAZE_AUTO is the plane.
static inline enum mrt_maze mrt_dictionary_maze(const struct mrt_dictionary_options *options)
{
    return options->maze == MRT_MAZE_AUTO ? MRT_MAZE_2D : (enum mrt_maze)options->maze;
}

// Adds the stages; `options` is copied. full: with the singular values of F (cube/I/sigma_F).
bool mrt_dictionary_bake(struct bake_plan *plan, const struct mrt_dictionary_options *options,
                         bool full);

// Members of the report of a complete bake of these options: "shapes" and "interface".
bool mrt_dictionary_report(struct report *report, struct bake *bake,
                           const struct mrt_dictionary_options *options);

enum { MRT_MAX_ENTERED = 3 };

struct mrt_entered {
    struct matrix_f32 t_r, u_r, u_rvec, u_rvol; // U_rvec: m·4 × k_r, U_rvol: p³·9 × k_r
};

struct mrt_element {
    struct mrt_shape shape;
    struct matrix_f32 u_b, t_db, l_imp, u_vec, u_bvol; // U_vec: n·4 × k_b, U_bvol: p³·9 × k_b
    struct matrix_f32 r_b[MRT_MAX_OPENINGS];           // by face; empty where none may leave
};

struct mrt_dictionary {
    struct mrt_dictionary_options options;
    int element_count;
    struct mrt_element element[MRT_MAX_CUBES];
    int turn_count;
    struct matrix_f32 r_turn[MRT_TURNS_3D];
    struct matrix_f32 r_hole[MRT_HOLE_PARTS]; // empty in tubes
    int entered_count;
    struct mrt_entered entered[MRT_MAX_ENTERED];
};

// Copies a bake made with these options. FAIL_FORMAT where a tensor is missing or of another shape.
bool mrt_dictionary_init(struct host *host, const struct tensors *bake,
                         const struct mrt_dictionary_options *options, struct mrt_dictionary *out);
void mrt_dictionary_finish(struct host *host, struct mrt_dictionary *dictionary);

// Bytes of U_b, T_d→b and U_vec, and of the operators of interfaces, which the paper counts as 4.7
// and 1.2 MB; volume probes and holes in walls are in neither.
struct mrt_dictionary_bytes {
    size_t shapes, interfaces, probes, holes;
};
struct mrt_dictionary_bytes mrt_dictionary_bytes(const struct mrt_dictionary *dictionary);
