// T_d→b of a block whose clutter hides parts of its walls from the rest of it.
//
// T_d→b projects direct light l onto the k_b modes L_imp: L_imp T_d→b l. What it puts at hidden
// texels the deltas take away again, but it also spreads their light, which may be far brighter as
// below a ceiling light, over the texels beside them. With the share W of a texel's rays that no
// clutter blocks, hidden texels have the light of the projection itself in place of their own,
//     b = T_d→b (W l + (1 − μ) (1 − W) L_imp b), so b = A⁻¹ T_d→b W l,
//     A = I − (1 − μ) T_d→b (1 − W) L_imp:
// the fit to the texels that are not hidden. μ keeps b from growing without bound where few are.
#include "techniques/mrt/objects/delta.h"

static const double DAMPING = 0.02;  // μ
static const double SMALLEST = 0.05; // singular value of A that is still inverted

// T_d→b with columns times `share`, or times 1 − share.
static bool scale_columns(struct host *host, const struct matrix_f32 *t_db, const float *share,
                          bool hidden, struct matrix_f64 *out)
{
    if (!matrix_f64_from_f32(host, t_db, out)) return false;
    for (size_t m = 0; m < out->rows; m++)
        for (size_t t = 0; t < out->columns; t++)
            out->at[m * out->stride + t] *= (double)(hidden ? 1.0f - share[t] : share[t]);
    return true;
}

static bool make_a(struct host *host, const struct matrix_f32 *t_db, const struct matrix_f32 *l_imp,
                   const float *share, struct matrix_f64 *out)
{
    struct matrix_f64 hidden = { 0 }, light = { 0 };
    bool ok = scale_columns(host, t_db, share, true, &hidden) &&
              matrix_f64_from_f32(host, l_imp, &light) &&
              matrix_f64_init(host, out, t_db->rows, t_db->rows) &&
              matrix_f64_multiply(host, DAMPING - 1.0, &hidden, NOT_TRANSPOSED, &light,
                                  NOT_TRANSPOSED, 0.0, out);
    for (size_t i = 0; ok && i < out->rows; i++) out->at[i * out->stride + i] += 1.0;
    matrix_f64_finish(host, &hidden);
    matrix_f64_finish(host, &light);
    return ok;
}

// V Σ⁺ Uᵀ · right, into t_db. Small singular values, σ / ε² of which are taken, count less.
static bool solve(struct host *host, const struct linalg_svd *a, const struct matrix_f64 *right,
                  struct matrix_f32 *t_db)
{
    struct matrix_f64 turned = { 0 }, solved = { 0 };
    bool ok =
        matrix_f64_init(host, &turned, a->count, right->columns) &&
        matrix_f64_init(host, &solved, a->count, right->columns) &&
        matrix_f64_multiply(host, 1.0, &a->u, TRANSPOSED, right, NOT_TRANSPOSED, 0.0, &turned);
    for (size_t i = 0; ok && i < a->count; i++) {
        const double sigma = a->sigma[i];
        for (size_t t = 0; t < turned.columns; t++)
            turned.at[i * turned.stride + t] *=
                sigma >= SMALLEST ? 1.0 / sigma : sigma / (SMALLEST * SMALLEST);
    }
    ok = ok &&
         matrix_f64_multiply(host, 1.0, &a->vt, TRANSPOSED, &turned, NOT_TRANSPOSED, 0.0, &solved);
    for (size_t m = 0; ok && m < t_db->rows; m++)
        for (size_t t = 0; t < t_db->columns; t++)
            t_db->at[m * t_db->stride + t] = (float)solved.at[m * solved.stride + t];
    matrix_f64_finish(host, &turned);
    matrix_f64_finish(host, &solved);
    return ok;
}

bool mrt_weigh_projection(struct host *host, const struct matrix_f32 *l_imp, const float *share,
                          struct matrix_f32 *t_db)
{
    struct matrix_f64 a = { 0 }, right = { 0 };
    struct linalg_svd svd = { 0 };
    const bool ok = make_a(host, t_db, l_imp, share, &a) &&
                    linalg_svd(host, "the projection of direct light", &a, &svd) &&
                    scale_columns(host, t_db, share, false, &right) &&
                    solve(host, &svd, &right, t_db);
    linalg_svd_finish(host, &svd);
    matrix_f64_finish(host, &a);
    matrix_f64_finish(host, &right);
    return ok;
}
