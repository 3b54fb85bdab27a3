// Singular vectors of the largest singular values alone, by the randomised range finder with power
// iterations (Halko, Martinsson & Tropp 2011, algorithm 4.4 and section 5.1).
#include "core/linalg.h"

#include "core/rng.h"

#include <string.h>

enum { OVERSAMPLING = 8, POWER_ITERATIONS = 2 };

static bool orthonormalise(struct host *host, const char *what, struct matrix_f64 *y)
{
    struct linalg_svd svd = { 0 };
    const bool ok = linalg_svd(host, what, y, &svd);
    for (size_t r = 0; ok && r < y->rows; r++)
        memcpy(y->at + r * y->stride, svd.u.at + r * svd.u.stride, y->columns * sizeof *y->at);
    linalg_svd_finish(host, &svd);
    return ok;
}

static void fill_random(struct matrix_f64 *m, uint64_t seed)
{
    for (size_t i = 0; i < m->rows * m->columns; i++)
        m->at[i] = (rng_mix(seed + i) & 1) != 0 ? 1.0 : -1.0;
}

// y: orthonormal columns that span most of the range of a.
static bool find_range(struct host *host, const char *what, const struct matrix_f64 *a,
                       struct matrix_f64 *y, uint64_t seed)
{
    struct matrix_f64 z = { 0 };
    bool ok = matrix_f64_init(host, &z, a->columns, y->columns);
    if (ok) fill_random(&z, seed);
    for (int i = 0; ok && i <= POWER_ITERATIONS; i++) {
        if (i > 0) ok = matrix_f64_multiply(host, 1.0, a, TRANSPOSED, y, NOT_TRANSPOSED, 0.0, &z);
        ok = ok && matrix_f64_multiply(host, 1.0, a, NOT_TRANSPOSED, &z, NOT_TRANSPOSED, 0.0, y) &&
             orthonormalise(host, what, y);
    }
    matrix_f64_finish(host, &z);
    return ok;
}

static size_t rank_of(const struct linalg_svd *svd, double total,
                      const struct linalg_truncation *how)
{
    double sum = 0.0;
    size_t rank = 0;
    while (rank < svd->count && rank < how->rank && sum < how->energy * total &&
           svd->sigma[rank] > 0.0) {
        sum += svd->sigma[rank] * svd->sigma[rank];
        rank++;
    }
    return rank;
}

bool linalg_truncated_left(struct host *host, const char *what, const struct matrix_f64 *a,
                           const struct linalg_truncation *how, struct matrix_f64 *out)
{
    size_t columns = how->rank + OVERSAMPLING;
    columns = columns < a->rows ? columns : a->rows;
    columns = columns < a->columns ? columns : a->columns;
    struct matrix_f64 y = { 0 }, b = { 0 };
    struct linalg_svd svd = { 0 };
    bool ok = matrix_f64_init(host, &y, a->rows, columns) &&
              matrix_f64_init(host, &b, columns, a->columns) &&
              find_range(host, what, a, &y, how->seed) &&
              matrix_f64_multiply(host, 1.0, &y, TRANSPOSED, a, NOT_TRANSPOSED, 0.0, &b) &&
              linalg_svd(host, what, &b, &svd);
    if (ok) {
        const double norm = matrix_f64_norm(a);
        const size_t rank = rank_of(&svd, norm * norm, how);
        const struct matrix_f64 kept = matrix_f64_block(&svd.u, 0, 0, svd.u.rows, rank);
        ok = matrix_f64_init(host, out, a->rows, rank) &&
             (rank == 0 ||
              matrix_f64_multiply(host, 1.0, &y, NOT_TRANSPOSED, &kept, NOT_TRANSPOSED, 0.0, out));
    }
    linalg_svd_finish(host, &svd);
    matrix_f64_finish(host, &y);
    matrix_f64_finish(host, &b);
    return ok;
}
