// The least squares of a projection.
#include "techniques/mrt/level/projection.h"

#include <string.h>

static const double NEGLIGIBLE = 1e-9; // of the largest eigenvalue of N: modes that are 0

// Rows times the areas of their texels, of which the mean is 1.
static bool weigh_rows(struct host *host, const struct mrt_projection *of,
                       const struct mrt_shape *shape, const struct matrix_f32 *from,
                       struct matrix_f32 *out)
{
    float mean = 0.0f;
    if (!matrix_f32_copy(host, from, from->columns, out)) return false;
    for (size_t t = 0; t < out->rows; t++) {
        const mat3s frame = mrt_shape_texel(shape, (int)t).frame;
        const vec3s u = glms_mat3_mulv(of->block_from_cell, frame.col[0]);
        const vec3s v = glms_mat3_mulv(of->block_from_cell, frame.col[1]);
        const float area = glms_vec3_norm(glms_vec3_cross(u, v));
        mean += area / (float)out->rows;
        for (size_t m = 0; m < out->columns; m++) out->at[t * out->stride + m] *= area;
    }
    for (size_t i = 0; i < out->rows * out->columns; i++) out->at[i] /= mean;
    return true;
}

// left ᵀ right, as doubles.
static bool product(struct host *host, const struct matrix_f32 *left,
                    const struct matrix_f32 *right, struct matrix_f64 *out)
{
    struct matrix_f32 sums = { 0 };
    const bool ok =
        matrix_f32_init(host, &sums, left->columns, right->columns) &&
        matrix_f32_multiply(host, 1.0f, left, TRANSPOSED, right, NOT_TRANSPOSED, 0.0f, &sums) &&
        matrix_f64_from_f32(host, &sums, out);
    matrix_f32_finish(host, &sums);
    return ok;
}

// rest: Uᵀ A (F − U T); n: N.
static bool make_equations(struct host *host, const struct mrt_projection *of,
                           const struct matrix_f32 *t_db, struct matrix_f64 *rest,
                           struct matrix_f64 *n)
{
    struct matrix_f32 u = { 0 }, light = { 0 };
    struct matrix_f64 t = { 0 }, walls = { 0 };
    bool ok = weigh_rows(host, of, &of->receivers, of->u_b, &u) &&
              weigh_rows(host, of, &of->shape, of->l_imp, &light) &&
              matrix_f64_from_f32(host, t_db, &t) && product(host, &u, of->f, rest) &&
              product(host, &u, of->u_b, n) && product(host, &light, of->l_imp, &walls) &&
              matrix_f64_multiply(host, -1.0, n, NOT_TRANSPOSED, &t, NOT_TRANSPOSED, 1.0, rest);
    for (size_t i = 0; ok && i < n->rows * n->columns; i++)
        n->at[i] += MRT_FIT_DAMPING * MRT_FIT_DAMPING * walls.at[i];
    matrix_f32_finish(host, &u);
    matrix_f32_finish(host, &light);
    matrix_f64_finish(host, &t);
    matrix_f64_finish(host, &walls);
    return ok;
}

// t_db += V Λ⁻¹ Vᵀ rest.
static bool add_solution(struct host *host, const struct linalg_eigen *n,
                         const struct matrix_f64 *rest, struct matrix_f32 *t_db)
{
    struct matrix_f64 turned = { 0 }, solved = { 0 };
    bool ok =
        matrix_f64_init(host, &turned, rest->rows, rest->columns) &&
        matrix_f64_init(host, &solved, rest->rows, rest->columns) &&
        matrix_f64_multiply(host, 1.0, &n->vectors, TRANSPOSED, rest, NOT_TRANSPOSED, 0.0, &turned);
    for (size_t i = 0; ok && i < turned.rows; i++) {
        const double value = n->values[i];
        const double inverse = value > NEGLIGIBLE * n->values[0] ? 1.0 / value : 0.0;
        for (size_t t = 0; t < turned.columns; t++) turned.at[i * turned.stride + t] *= inverse;
    }
    ok = ok && matrix_f64_multiply(host, 1.0, &n->vectors, NOT_TRANSPOSED, &turned, NOT_TRANSPOSED,
                                   0.0, &solved);
    for (size_t m = 0; ok && m < t_db->rows; m++)
        for (size_t t = 0; t < t_db->columns; t++)
            t_db->at[m * t_db->stride + t] += (float)solved.at[m * solved.stride + t];
    matrix_f64_finish(host, &turned);
    matrix_f64_finish(host, &solved);
    return ok;
}

bool mrt_fit_projection(struct host *host, const struct mrt_projection *of, struct matrix_f32 *t_db)
{
    struct matrix_f64 rest = { 0 }, n = { 0 };
    struct linalg_eigen eigen = { 0 };
    const bool ok = make_equations(host, of, t_db, &rest, &n) &&
                    linalg_symmetric_eigen(host, "the projection of direct light", &n, &eigen) &&
                    add_solution(host, &eigen, &rest, t_db);
    linalg_eigen_finish(host, &eigen);
    matrix_f64_finish(host, &rest);
    matrix_f64_finish(host, &n);
    return ok;
}

bool mrt_rows_of_walls(struct host *host, const struct mrt_shape *shape,
                       const struct matrix_f32 *faces, struct matrix_f32 *out)
{
    const size_t face = (size_t)(shape->resolution * shape->resolution);
    size_t to = 0;
    if (!matrix_f32_init(host, out, (size_t)mrt_shape_texels(shape), faces->columns)) return false;
    for (size_t f = 0; f < CUBE_FACES; f++) {
        if (mrt_shape_is_open(shape, (int)f)) continue;
        memcpy(out->at + to * out->stride, faces->at + f * face * faces->stride,
               face * faces->stride * sizeof *out->at);
        to += face;
    }
    return true;
}
