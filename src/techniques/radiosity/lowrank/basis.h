// The low-rank form of a matrix of transfer: A ≈ Σ u_k v_kᵀ, in which the first mode has the row
// sums, so that uniform light is exact.
#pragma once

#include "core/linalg.h"
#include "techniques/radiosity/radiosity_tree.h"

// Rows of a texel: irradiance, and two components of the vector irradiance along the surface.
enum { RADIOSITY_COMPONENTS = 3 };

struct radiosity_operator {
    const struct matrix_f64 *rows; // [RADIOSITY_COMPONENTS · texels][sources]
    const uint32_t *nodes;         // [sources] of the tree, of which none is above another
    const struct radiosity_tree *tree;
    uint32_t *number; // [nodes of the tree] scratch: all 0 between the calls
};

struct radiosity_basis_how {
    float energy;  // share of the squared norm that is kept
    uint32_t most; // modes, at least 1
    uint64_t seed;
};

struct radiosity_basis {
    struct matrix_f64 u; // [RADIOSITY_COMPONENTS · texels][count]
    struct matrix_f64 v; // [count][sources]; row 0 sums to 1, the others to 0
    uint32_t count;
};
// Free with radiosity_basis_finish, which accepts zero.
bool radiosity_basis_init(struct radiosity_basis *out, struct host *host,
                          const struct radiosity_operator *of,
                          const struct radiosity_basis_how *how);
void radiosity_basis_finish(struct radiosity_basis *basis, struct host *host);
