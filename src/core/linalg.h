// Dense linear algebra for precomputation: products, thin singular value decomposition and
// symmetric eigenvalues, through CBLAS and LAPACKE.
//
// Matrices are row-major: element (r, c) is at[r * stride + c]. Every function runs BLAS on one
// thread and on aligned copies where that decides rounding, so results are the same bytes whatever
// the number of threads and the placement of memory, on machines of one kind. Calls on several
// threads are safe and run in parallel: parallel work is many tasks, not one large call.
#pragma once

#include "core/host.h"

#include <stdint.h>

struct matrix_f32 {
    float *at; // rows × columns
    size_t rows, columns;
    size_t stride; // elements from one row to the next, at least `columns`
};

struct matrix_f64 {
    double *at; // rows × columns
    size_t rows, columns;
    size_t stride;
};

// Zeroed and contiguous (stride = columns). Free with _finish, which accepts zero.
bool matrix_f32_init(struct host *host, struct matrix_f32 *m, size_t rows, size_t columns);
bool matrix_f64_init(struct host *host, struct matrix_f64 *m, size_t rows, size_t columns);
void matrix_f32_finish(struct host *host, struct matrix_f32 *m);
void matrix_f64_finish(struct host *host, struct matrix_f64 *m);
// Contiguous copies; f32: of at least as many columns, zeros beyond those of `from`.
bool matrix_f32_copy(struct host *host, const struct matrix_f32 *from, size_t columns,
                     struct matrix_f32 *out);
bool matrix_f64_from_f32(struct host *host, const struct matrix_f32 *from, struct matrix_f64 *out);
// The block of rows first_row… and columns first_column…, in the memory of m; never finish it.
struct matrix_f32 matrix_f32_block(const struct matrix_f32 *m, size_t first_row,
                                   size_t first_column, size_t rows, size_t columns);
struct matrix_f64 matrix_f64_block(const struct matrix_f64 *m, size_t first_row,
                                   size_t first_column, size_t rows, size_t columns);

enum transposed { NOT_TRANSPOSED, TRANSPOSED };

// out = alpha · op(a) · op(b) + beta · out, where op transposes if asked to. op(a) is m×k, op(b)
// k×n, out m×n. `out` overlaps neither a nor b. beta 0 overwrites `out`, NaN included.
// FAIL_ARGUMENT with the three shapes where they do not fit.
bool matrix_f32_multiply(struct host *host, float alpha, const struct matrix_f32 *a,
                         enum transposed op_a, const struct matrix_f32 *b, enum transposed op_b,
                         float beta, struct matrix_f32 *out);
bool matrix_f64_multiply(struct host *host, double alpha, const struct matrix_f64 *a,
                         enum transposed op_a, const struct matrix_f64 *b, enum transposed op_b,
                         double beta, struct matrix_f64 *out);

// a = u · diag(sigma) · vt, with k = min(m, n).
struct linalg_svd {
    struct matrix_f64 u;  // m×k, orthonormal columns
    double *sigma;        // k, descending, at least 0
    struct matrix_f64 vt; // k×n, orthonormal rows
    size_t count;         // k
};
// Thin SVD (LAPACK's gesdd). In each column of u the component of largest magnitude is positive; of
// equal ones (to 1e-9) the first. `what` names the matrix in messages. FAIL_ARGUMENT where an
// element is not finite. Free with linalg_svd_finish, which accepts zero.
bool linalg_svd(struct host *host, const char *what, const struct matrix_f64 *a,
                struct linalg_svd *out);
void linalg_svd_finish(struct host *host, struct linalg_svd *svd);

// How many singular vectors are kept: those of the largest values until their squares sum to a
// share of ‖a‖², at most `rank`.
struct linalg_truncation {
    double energy; // the share, 0…1
    size_t rank;   // at least 1
    uint64_t seed; // of the random range finder; the same seed gives the same bytes
};
// The left singular vectors of a that are kept: m×k, orthonormal columns; uᵀ a has the rest of the
// truncated decomposition. `out` is made here, also of no columns where a is 0; free with _finish.
bool linalg_truncated_left(struct host *host, const char *what, const struct matrix_f64 *a,
                           const struct linalg_truncation *how, struct matrix_f64 *out);

// a = vectors · diag(values) · vectorsᵀ of a symmetric n×n matrix, of which the lower triangle is
// read. Values descend. Signs of the columns as in linalg_svd.
struct linalg_eigen {
    struct matrix_f64 vectors; // n×n, orthonormal columns
    double *values;            // n
};
bool linalg_symmetric_eigen(struct host *host, const char *what, const struct matrix_f64 *a,
                            struct linalg_eigen *out);
void linalg_eigen_finish(struct host *host, struct linalg_eigen *eigen);

// √Σ aᵢⱼ², in double precision.
double matrix_f32_norm(const struct matrix_f32 *a);
double matrix_f64_norm(const struct matrix_f64 *a);
// ‖aᵀa − I‖: 0 where the columns are orthonormal. NaN when out of memory.
double matrix_f64_orthonormality(struct host *host, const struct matrix_f64 *a);

// Between the two, BLAS runs on one thread for the whole process; the calls nest and may come from
// any thread. All functions above do this themselves; only direct users of a BLAS library need it.
void linalg_one_thread_begin(void);
void linalg_one_thread_end(void);
