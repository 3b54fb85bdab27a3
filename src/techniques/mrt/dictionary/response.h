// Response of a block to the light of an interface (Loos 2015, sections 3.4.1 and 4.2.3): the
// decomposition of G = F_rlf H_rlf.
#pragma once

#include "core/linalg.h"

struct mrt_response {
    struct matrix_f32 u_r;  // texels × k_r, orthonormal: irradiance of one unit of r-coefficients
    struct matrix_f32 t_r;  // k_r × k_rlf: r-coefficients of lightfield coefficients
    struct matrix_f32 lift; // k_rlf × k_r: lightfield coefficients of r-coefficients
};

// `g`: texels × k_rlf.
bool mrt_response_init(struct host *host, const struct matrix_f32 *g, int k_r,
                       struct mrt_response *out);
void mrt_response_finish(struct host *host, struct mrt_response *response);
