// Decomposition of lightfields through Gram matrices.
//
// The columns of H_lf are hundreds and its rows 82944: eigenvectors of HᵀH cost far less than an
// SVD of H. Squaring halves the accuracy: singular values below 1e-5 of the largest are noise.
#include "basis.h"

#include <math.h>
#include <string.h>

static const double NEGLIGIBLE = 1e-5;
enum { CHUNK = 512 }; // rows converted to double precision at once

size_t mrt_span_columns(const struct mrt_span *span)
{
    size_t columns = 0;
    for (int p = 0; p < span->parts; p++) columns += span->part[p].columns;
    return columns;
}

static void fill_chunk(const struct mrt_span *span, size_t first_row, struct matrix_f64 *chunk)
{
    size_t first = 0;
    for (int p = 0; p < span->parts; p++) {
        const struct matrix_f32 *part = &span->part[p];
        for (size_t r = 0; r < chunk->rows; r++)
            for (size_t c = 0; c < part->columns; c++)
                chunk->at[r * chunk->stride + first + c] =
                    (double)part->at[(first_row + r) * part->stride + c];
        first += part->columns;
    }
}

bool mrt_span_gram(struct host *host, const struct mrt_span *span, size_t first_row, size_t rows,
                   struct matrix_f64 *gram)
{
    struct matrix_f64 chunk = { 0 };
    bool ok = matrix_f64_init(host, &chunk, CHUNK, mrt_span_columns(span));
    for (size_t done = 0; ok && done < rows; done += chunk.rows) {
        chunk.rows = rows - done < CHUNK ? rows - done : CHUNK;
        fill_chunk(span, first_row + done, &chunk);
        ok = matrix_f64_multiply(host, 1.0, &chunk, TRANSPOSED, &chunk, NOT_TRANSPOSED, 1.0, gram);
    }
    matrix_f64_finish(host, &chunk);
    return ok;
}

void mrt_span_balance(const struct matrix_f64 *gram, size_t part_columns, double *factor)
{
    double squared[MRT_SPAN_PARTS] = { 0 };
    for (size_t c = 0; c < gram->columns; c++)
        squared[c >= part_columns] += gram->at[c * gram->stride + c];
    for (size_t c = 0; c < gram->columns; c++) factor[c] = 1.0 / sqrt(squared[c >= part_columns]);
}

static void scale_gram(const double *factor, struct matrix_f64 *gram)
{
    for (size_t r = 0; r < gram->rows; r++)
        for (size_t c = 0; c < gram->columns; c++)
            gram->at[r * gram->stride + c] *= factor[r] * factor[c];
}

bool mrt_span_reduce(struct host *host, const struct matrix_f64 *gram, const double *factor,
                     struct matrix_f32 *coefficients, double *sigma)
{
    struct matrix_f64 scaled = { 0 };
    struct linalg_eigen eigen = { 0 };
    bool ok = matrix_f64_init(host, &scaled, gram->rows, gram->columns);
    if (ok) {
        for (size_t r = 0; r < gram->rows; r++)
            memcpy(scaled.at + r * scaled.stride, gram->at + r * gram->stride,
                   gram->columns * sizeof *gram->at);
        scale_gram(factor, &scaled);
        ok = linalg_symmetric_eigen(host, "the lightfields", &scaled, &eigen);
    }
    for (size_t m = 0; ok && m < coefficients->columns; m++) {
        double value = m < gram->rows ? sqrt(fmax(eigen.values[m], 0.0)) : 0.0;
        sigma[m] = value > NEGLIGIBLE * sqrt(eigen.values[0]) ? value : 0.0;
        for (size_t r = 0; r < gram->rows; r++)
            coefficients->at[r * coefficients->stride + m] =
                sigma[m] > 0.0 ? (float)(factor[r] * eigen.vectors.at[r * eigen.vectors.stride + m])
                               : 0.0f;
    }
    linalg_eigen_finish(host, &eigen);
    matrix_f64_finish(host, &scaled);
    return ok;
}

bool mrt_span_apply(struct host *host, const struct mrt_span *span, size_t first_row,
                    const struct matrix_f32 *coefficients, struct matrix_f32 *out)
{
    size_t first = 0;
    for (int p = 0; p < span->parts; p++) {
        struct matrix_f32 from =
            matrix_f32_block(&span->part[p], first_row, 0, out->rows, span->part[p].columns);
        struct matrix_f32 by =
            matrix_f32_block(coefficients, first, 0, from.columns, coefficients->columns);
        if (!matrix_f32_multiply(host, 1.0f, &from, NOT_TRANSPOSED, &by, NOT_TRANSPOSED, p > 0,
                                 out))
            return false;
        first += from.columns;
    }
    return true;
}

bool mrt_project_add(struct host *host, const struct matrix_f32 *basis,
                     const struct matrix_f32 *lightfields, size_t first_row, size_t rows,
                     struct matrix_f32 *sum)
{
    struct matrix_f32 a = matrix_f32_block(basis, first_row, 0, rows, basis->columns);
    struct matrix_f32 b = matrix_f32_block(lightfields, first_row, 0, rows, lightfields->columns);
    return matrix_f32_multiply(host, 1.0f, &a, TRANSPOSED, &b, NOT_TRANSPOSED, 1.0f, sum);
}

void mrt_project_finish(const struct matrix_f32 *product, const struct matrix_f32 *sigma,
                        size_t first, size_t width, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < product->rows; r++) {
            const double s = (double)sigma->at[r];
            const float *from = product->at + r * product->stride + first + i * width;
            for (size_t c = 0; c < width; c++)
                *to++ = s > 0.0 ? (float)((double)from[c] / (s * s)) : 0.0f;
        }
}
