// Points of many numbers, projected onto the largest principal vectors of a sample of them. The
// projection changes distances by the variance outside of the subspace alone.
#include "techniques/prt/compress/compress.h"

#include "core/linalg.h"

#include <string.h>

enum { MOST_NUMBERS = 128, MOST_SAMPLES = 4096 };

// Columns are points at equal steps.
static bool sample(const struct prt_points *points, struct host *host, struct matrix_f64 *out)
{
    const size_t count = points->count < MOST_SAMPLES ? points->count : MOST_SAMPLES;
    if (!matrix_f64_init(host, out, points->dim, count)) return false;
    for (size_t i = 0; i < count; i++) {
        const float *point = points->at + i * points->count / count * points->dim;
        for (size_t d = 0; d < points->dim; d++) out->at[d * out->stride + i] = (double)point[d];
    }
    return true;
}

static bool find_basis(const struct prt_points *points, const struct prt_compression *how,
                       struct host *host, struct matrix_f32 *out)
{
    const struct linalg_truncation truncation = { 1.0, MOST_NUMBERS, how->seed };
    struct matrix_f64 samples = { 0 }, left = { 0 };
    bool ok = sample(points, host, &samples) &&
              linalg_truncated_left(host, "transfer matrices", &samples, &truncation, &left) &&
              matrix_f32_init(host, out, left.rows, left.columns);
    for (size_t d = 0; ok && d < left.rows; d++)
        for (size_t k = 0; k < left.columns; k++)
            out->at[d * out->stride + k] = (float)left.at[d * left.stride + k];
    matrix_f64_finish(host, &samples);
    matrix_f64_finish(host, &left);
    return ok;
}

bool prt_reduce(struct host *host, const struct prt_points *points,
                const struct prt_compression *how, struct prt_reduction *out)
{
    *out = (struct prt_reduction){ .host = host };
    if (points->dim <= MOST_NUMBERS) return true;
    if (!find_basis(points, how, host, &out->basis)) return false;
    const size_t numbers = out->basis.columns;
    const struct matrix_f32 x = { (float *)points->at, points->count, points->dim, points->dim };
    if (numbers == 0) return true;
    if (!matrix_f32_init(host, &out->points, points->count, numbers)) return false;
    return matrix_f32_multiply(host, 1, &x, NOT_TRANSPOSED, &out->basis, NOT_TRANSPOSED, 0,
                               &out->points);
}

bool prt_expand(const struct prt_reduction *reduction, struct prt_codebook *book)
{
    struct host *host = reduction->host;
    const size_t rows = book->clusters * (1 + book->vectors);
    const struct matrix_f32 reduced = { book->rows, rows, book->dim, book->dim };
    struct matrix_f32 whole = { 0 };
    if (!matrix_f32_init(host, &whole, rows, reduction->basis.rows)) return false;
    if (!matrix_f32_multiply(host, 1, &reduced, NOT_TRANSPOSED, &reduction->basis, TRANSPOSED, 0,
                             &whole)) {
        matrix_f32_finish(host, &whole);
        return false;
    }
    host_free(host, book->rows);
    book->rows = whole.at;
    book->dim = whole.columns;
    return true;
}

void prt_reduction_finish(struct prt_reduction *reduction)
{
    if (!reduction->host) return;
    matrix_f32_finish(reduction->host, &reduction->basis);
    matrix_f32_finish(reduction->host, &reduction->points);
}
