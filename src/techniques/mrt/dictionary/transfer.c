// The light prior, M = F P S, and the operators that follow from its decomposition.
//
// A plane does not light itself: where a shape has one face alone, M is 0, and its b-coefficients
// are modes of the prior, which still light the blocks beyond its openings.
//
// Differs from the paper: modes of the prior whose singular value is below 1e-6 of the largest are
// left out, because T_d→b divides by it; shapes with few texels have such modes.
#include "transfer.h"

#include "core/linalg.h"

#include <math.h>
#include <string.h>

static const double NEGLIGIBLE = 1e-6;

int mrt_modes_for_energy(const double *sigma, size_t count, double share)
{
    double all = 0.0, sum = 0.0;
    for (size_t i = 0; i < count; i++) all += sigma[i] * sigma[i];
    for (size_t i = 0; i < count; i++) {
        sum += sigma[i] * sigma[i];
        if (sum >= share * all) return (int)i + 1;
    }
    return (int)count;
}

static void basis_finish(struct host *host, struct mrt_basis *basis)
{
    matrix_f64_finish(host, &basis->p);
    host_free(host, basis->s);
    *basis = (struct mrt_basis){ 0 };
}

static size_t useful_modes(const double *sigma, size_t count, int wanted)
{
    size_t kept = 0;
    while (kept < count && kept < (size_t)wanted && sigma[kept] > NEGLIGIBLE * sigma[0]) kept++;
    return kept;
}

static void copy_columns(const struct matrix_f64 *from, const double *scale, double factor,
                         size_t first, struct matrix_f64 *to)
{
    for (size_t r = 0; r < from->rows; r++)
        for (size_t c = 0; c < from->columns; c++)
            to->at[r * to->stride + first + c] =
                from->at[r * from->stride + c] * (scale ? scale[c] : 1.0) * factor;
}

// The left singular vectors and values of `span`. Gives all values to *sigma where it is not NULL.
static bool basis_init(struct host *host, const char *what, const struct matrix_f64 *span,
                       int modes, struct mrt_basis *out, double **sigma, size_t *sigma_count)
{
    struct linalg_svd svd = { 0 };
    *out = (struct mrt_basis){ 0 };
    if (!linalg_svd(host, what, span, &svd)) return false;
    out->count = useful_modes(svd.sigma, svd.count, modes);
    out->s = host_alloc(host, out->count, sizeof *out->s);
    bool ok = out->s && matrix_f64_init(host, &out->p, span->rows, out->count);
    if (ok) {
        struct matrix_f64 kept = matrix_f64_block(&svd.u, 0, 0, span->rows, out->count);
        copy_columns(&kept, NULL, 1.0, 0, &out->p);
        memcpy(out->s, svd.sigma, out->count * sizeof *out->s);
    }
    if (ok && sigma) {
        *sigma = svd.sigma;
        *sigma_count = svd.count;
        svd.sigma = NULL;
    }
    linalg_svd_finish(host, &svd);
    return ok;
}

// M = F P S and its decomposition.
static bool decompose(struct host *host, const struct matrix_f64 *f, const struct mrt_basis *basis,
                      struct linalg_svd *out)
{
    struct matrix_f64 m = { 0 };
    bool ok = matrix_f64_init(host, &m, f->rows, basis->count) &&
              matrix_f64_multiply(host, 1.0, f, NOT_TRANSPOSED, &basis->p, NOT_TRANSPOSED, 0.0, &m);
    if (ok) {
        copy_columns(&m, basis->s, 1.0, 0, &m);
        ok = linalg_svd(host, "the indirect light of the prior", &m, out);
    }
    matrix_f64_finish(host, &m);
    return ok;
}

// Columns that are constant on one patch and 0 elsewhere.
static void set_patch_constants(const struct mrt_shape *shape, double value, size_t first,
                                struct matrix_f64 *to)
{
    for (size_t r = 0; r < to->rows; r++)
        for (int patch = 0; patch < mrt_shape_patches(shape); patch++)
            to->at[r * to->stride + first + (size_t)patch] =
                mrt_shape_patch(shape, (int)r) == patch ? value : 0.0;
}

// Appendix A: the scaled prior, a constant per face (patch) and the indirect light U_b, each with a
// Frobenius norm of 1, decomposed together.
static bool enrich(struct host *host, const struct mrt_shape *shape, const struct matrix_f64 *f,
                   const struct mrt_transfer_options *options, struct mrt_basis *basis)
{
    struct linalg_svd m = { 0 };
    struct matrix_f64 span = { 0 };
    struct mrt_basis better = { 0 };
    if (!decompose(host, f, basis, &m)) return false;
    size_t faces = (size_t)mrt_shape_patches(shape);
    size_t indirect = useful_modes(m.sigma, m.count, options->k_b);
    bool ok = matrix_f64_init(host, &span, f->rows, basis->count + faces + indirect);
    if (ok) {
        struct matrix_f64 s = { basis->s, 1, basis->count, basis->count };
        struct matrix_f64 sigma = { m.sigma, 1, indirect, indirect };
        struct matrix_f64 u = matrix_f64_block(&m.u, 0, 0, f->rows, indirect);
        copy_columns(&basis->p, basis->s, 1.0 / matrix_f64_norm(&s), 0, &span);
        set_patch_constants(shape, 1.0 / sqrt((double)f->rows), basis->count, &span);
        copy_columns(&u, m.sigma, 1.0 / matrix_f64_norm(&sigma), basis->count + faces, &span);
        ok = basis_init(host, "the enriched light prior", &span, options->k_d, &better, NULL, NULL);
    }
    if (ok) {
        basis_finish(host, basis);
        *basis = better;
    }
    matrix_f64_finish(host, &span);
    linalg_svd_finish(host, &m);
    return ok;
}

// Rows V_mᵀ S⁻¹ of the modes kept, and V_mᵀ S, both kept × k_d.
static void scale_vt(const struct linalg_svd *m, const struct mrt_basis *basis, bool inverse,
                     struct matrix_f64 *out)
{
    for (size_t r = 0; r < out->rows; r++)
        for (size_t c = 0; c < out->columns; c++)
            out->at[r * out->stride + c] =
                m->vt.at[r * m->vt.stride + c] * (inverse ? 1.0 / basis->s[c] : basis->s[c]);
}

// U_b = U_m Σ_m, T_d→b = V_mᵀ S⁻¹ Pᵀ, L_imp = P S V_m, each with its first `kept` modes.
static bool set_operators(struct host *host, const struct linalg_svd *m,
                          const struct mrt_basis *basis, size_t kept, struct mrt_transfer *out)
{
    struct matrix_f64 v = { 0 };
    size_t n = out->u_b.rows;
    if (!matrix_f64_init(host, &v, kept, basis->count)) return false;
    struct matrix_f64 u = matrix_f64_block(&m->u, 0, 0, n, kept);
    struct matrix_f64 t_db = matrix_f64_block(&out->t_db, 0, 0, kept, n);
    struct matrix_f64 l_imp = matrix_f64_block(&out->l_imp, 0, 0, n, kept);
    copy_columns(&u, m->sigma, 1.0, 0, &out->u_b);
    out->orthonormality = matrix_f64_orthonormality(host, &u);
    scale_vt(m, basis, true, &v);
    bool ok = matrix_f64_multiply(host, 1.0, &v, NOT_TRANSPOSED, &basis->p, TRANSPOSED, 0.0, &t_db);
    scale_vt(m, basis, false, &v);
    ok = ok &&
         matrix_f64_multiply(host, 1.0, &basis->p, NOT_TRANSPOSED, &v, TRANSPOSED, 0.0, &l_imp);
    matrix_f64_finish(host, &v);
    return ok;
}

static bool measure_implicit(struct host *host, const struct matrix_f64 *f,
                             struct mrt_transfer *out)
{
    struct matrix_f64 rest = { 0 };
    bool ok = matrix_f64_init(host, &rest, f->rows, out->u_b.columns);
    if (ok) copy_columns(&out->u_b, NULL, -1.0, 0, &rest);
    ok = ok &&
         matrix_f64_multiply(host, 1.0, f, NOT_TRANSPOSED, &out->l_imp, NOT_TRANSPOSED, 1.0, &rest);
    double norm = matrix_f64_norm(&out->u_b);
    if (ok && norm > 0.0) out->implicit_error = matrix_f64_norm(&rest) / norm;
    matrix_f64_finish(host, &rest);
    return ok;
}

static bool build(struct host *host, const struct matrix_f64 *f, const struct mrt_basis *basis,
                  int k_b, struct mrt_transfer *out)
{
    struct linalg_svd m = { 0 };
    bool ok = decompose(host, f, basis, &m) &&
              set_operators(host, &m, basis, m.count < (size_t)k_b ? m.count : (size_t)k_b, out) &&
              measure_implicit(host, f, out);
    if (ok) {
        out->sigma_m = m.sigma;
        out->sigma_m_count = m.count;
        m.sigma = NULL;
    }
    linalg_svd_finish(host, &m);
    return ok;
}

bool mrt_transfer_init(struct host *host, const struct mrt_shape *shape, const struct matrix_f64 *f,
                       const struct matrix_f64 *direct, const struct mrt_transfer_options *options,
                       struct mrt_transfer *out)
{
    struct mrt_basis basis = { 0 };
    size_t n = f->rows, k = (size_t)options->k_b;
    *out = (struct mrt_transfer){ 0 };
    bool ok = matrix_f64_init(host, &out->u_b, n, k) && matrix_f64_init(host, &out->t_db, k, n) &&
              matrix_f64_init(host, &out->l_imp, n, k) &&
              basis_init(host, "the direct light of the prior", direct, options->k_d, &basis,
                         &out->sigma_l, &out->sigma_l_count);
    if (ok && options->enrich) ok = enrich(host, shape, f, options, &basis);
    ok = ok && build(host, f, &basis, options->k_b, out);
    basis_finish(host, &basis);
    if (!ok) mrt_transfer_finish(host, out);
    return ok;
}

void mrt_transfer_finish(struct host *host, struct mrt_transfer *transfer)
{
    matrix_f64_finish(host, &transfer->u_b);
    matrix_f64_finish(host, &transfer->t_db);
    matrix_f64_finish(host, &transfer->l_imp);
    host_free(host, transfer->sigma_l);
    host_free(host, transfer->sigma_m);
    *transfer = (struct mrt_transfer){ 0 };
}
