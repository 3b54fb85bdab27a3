// Reduced lightfield basis H_rlf = U Σ (Loos 2015, section 3.4.1, appendix A): the left singular
// vectors and values of a matrix with many rows, by the eigenvectors of its small Gram matrix.
#pragma once

#include "core/linalg.h"

enum { MRT_SPAN_PARTS = 2 };

// The columns of up to two matrices with the same rows, beside each other.
struct mrt_span {
    struct matrix_f32 part[MRT_SPAN_PARTS];
    int parts;
};

size_t mrt_span_columns(const struct mrt_span *span);

// Adds rows first_row … first_row + rows − 1 to the Gram matrix (columns × columns).
bool mrt_span_gram(struct host *host, const struct mrt_span *span, size_t first_row, size_t rows,
                   struct matrix_f64 *gram);

// From the Gram matrix of a span and a factor for each column: `coefficients` (columns × modes), so
// that span · coefficients = U Σ of the scaled span, and `sigma` (modes), descending. Modes below
// the accuracy of a Gram matrix are 0.
bool mrt_span_reduce(struct host *host, const struct matrix_f64 *gram, const double *factor,
                     struct matrix_f32 *coefficients, double *sigma);

// Factors that give each part a Frobenius norm of 1 (appendix A). `part_columns` of the first part.
void mrt_span_balance(const struct matrix_f64 *gram, size_t part_columns, double *factor);

// Rows of span · coefficients, for as many rows as `out` has.
bool mrt_span_apply(struct host *host, const struct mrt_span *span, size_t first_row,
                    const struct matrix_f32 *coefficients, struct matrix_f32 *out);

// Coefficients with respect to U Σ of lightfields: Σ⁻² (UΣ)ᵀ · lightfields. First the product of
// some rows is added up, then divided.
bool mrt_project_add(struct host *host, const struct matrix_f32 *basis,
                     const struct matrix_f32 *lightfields, size_t first_row, size_t rows,
                     struct matrix_f32 *sum);
// `sigma` is one row; `count` times `width` columns of the product, from `first` on, are stored as
// matrices behind each other.
void mrt_project_finish(const struct matrix_f32 *product, const struct matrix_f32 *sigma,
                        size_t first, size_t width, size_t count, float *to);
