// T_d→b of blocks whose light differs from that of their cube: blocks of other proportions, and
// with objects in them.
//
// Direct light l on walls becomes L_imp b with b = T_d→b l. The dictionary's T_d→b leaves out what
// the one-bounce operator of a cube turns into little irradiance. The operator F of the block, with
// U_b = F L_imp, makes more of it. With the areas A of texels, the change δ of b has the least
//     ‖F (l − L_imp T_d→b l) − U_b δ‖²_A + ε² ‖L_imp δ‖²_A,
// so that
//     T_d→b ← T_d→b + N⁻¹ U_bᵀ A (F − U_b T_d→b),   N = U_bᵀ A U_b + ε² L_impᵀ A L_imp.
// ε = MRT_FIT_DAMPING, irradiance (lux) by radiosity (lm/m²), keeps L_imp b near the direct light,
// since it is what other blocks and objects see. T_d→b L_imp = I stays. Light is reciprocal, so F
// is symmetric with respect to A, and its norm is at most 1: bounces cannot grow by the fit. Rows
// of F and U_b are of openings, too, as if they were walls: what leaves there lights other blocks.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/shape.h"

#define MRT_FIT_DAMPING 0.1

struct mrt_projection {
    struct mrt_shape shape;         // of n texels
    struct mrt_shape receivers;     // of m: its walls, and its openings as places that see it
    mat3s block_from_cell;          // Jacobian of the warp, for the areas
    const struct matrix_f32 *f;     // m × n
    const struct matrix_f32 *u_b;   // m × k_b
    const struct matrix_f32 *l_imp; // n × k_b
};

// Changes t_db (k_b × n).
bool mrt_fit_projection(struct host *host, const struct mrt_projection *of,
                        struct matrix_f32 *t_db);
// The rows of a cube's walls, of those of all six faces.
bool mrt_rows_of_walls(struct host *host, const struct mrt_shape *shape,
                       const struct matrix_f32 *faces, struct matrix_f32 *out);
