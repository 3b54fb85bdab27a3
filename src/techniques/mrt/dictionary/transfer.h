// Reduced direct-to-indirect transfer of one shape (Loos 2015, section 3.3, appendix A): from the
// one-bounce operator F and the direct light of the prior to the bases U_b, T_d→b and L_imp.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/shape.h"

// The light prior: P · diag(s) spans the direct light that is represented.
struct mrt_basis {
    struct matrix_f64 p; // texels × count, orthonormal columns
    double *s;           // count, descending
    size_t count;
};

struct mrt_transfer_options {
    int k_d, k_b; // modes of the prior and of indirect light
    bool enrich;
};

// n: texels of the shape. Light is radiosity (lm/m²) in and irradiance (lux) out; b-coefficients
// have no unit of their own.
struct mrt_transfer {
    struct matrix_f64 u_b;   // n × k_b: irradiance of one unit of each b-coefficient
    struct matrix_f64 t_db;  // k_b × n: b-coefficients of radiosity at each texel
    struct matrix_f64 l_imp; // n × k_b: the radiosity whose indirect light is u_b
    double *sigma_l;         // sigma_l_count singular values of the direct light of the prior
    double *sigma_m;         // k_d singular values of M = F P S
    size_t sigma_l_count, sigma_m_count;
    double orthonormality; // ‖U_mᵀ U_m − I‖ of the modes kept
    double implicit_error; // ‖F L_imp − U_b‖ / ‖U_b‖
};

// `direct`: n × lights. Where the prior has fewer modes than k_b, the rest are 0.
bool mrt_transfer_init(struct host *host, const struct mrt_shape *shape, const struct matrix_f64 *f,
                       const struct matrix_f64 *direct, const struct mrt_transfer_options *options,
                       struct mrt_transfer *out);
void mrt_transfer_finish(struct host *host, struct mrt_transfer *transfer);

// Singular values that reach a share of Σσ² (table 3.2).
int mrt_modes_for_energy(const double *sigma, size_t count, double share);
