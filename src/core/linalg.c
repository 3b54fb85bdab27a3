// Dense linear algebra through CBLAS and LAPACKE (OpenBLAS).
//
// LAPACK is column-major: a row-major m×n matrix is its n×m transpose. Where a = U Σ Vᵀ,
// aᵀ = V Σ Uᵀ, so the left vectors that LAPACK returns, read row-major, are Vᵀ, and the right ones
// U. No copy is transposed.
#include "core/linalg.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>

#include <cblas.h>
#include <lapacke.h>

// ---- one thread

static pthread_mutex_t scope_mutex = PTHREAD_MUTEX_INITIALIZER;
static int scope_depth, threads_before; // under the mutex

void linalg_one_thread_begin(void)
{
    pthread_mutex_lock(&scope_mutex);
    if (scope_depth++ == 0) {
        threads_before = openblas_get_num_threads();
        openblas_set_num_threads(1);
    }
    pthread_mutex_unlock(&scope_mutex);
}

void linalg_one_thread_end(void)
{
    pthread_mutex_lock(&scope_mutex);
    assert(scope_depth > 0);
    if (--scope_depth == 0) openblas_set_num_threads(threads_before);
    pthread_mutex_unlock(&scope_mutex);
}

// ---- matrices

static bool area(struct host *host, size_t rows, size_t columns, size_t *out)
{
    if (rows <= INT_MAX && columns <= INT_MAX && size_mul(rows, columns, out)) return true;
    return host_fail(host, FAIL_MEMORY, "cannot make a matrix of %zu x %zu: too large", rows,
                     columns);
}

bool matrix_f32_init(struct host *host, struct matrix_f32 *m, size_t rows, size_t columns)
{
    size_t count = 0;
    *m = (struct matrix_f32){ .rows = rows, .columns = columns, .stride = columns };
    if (area(host, rows, columns, &count)) m->at = host_alloc(host, count, sizeof *m->at);
    return m->at != NULL;
}

bool matrix_f64_init(struct host *host, struct matrix_f64 *m, size_t rows, size_t columns)
{
    size_t count = 0;
    *m = (struct matrix_f64){ .rows = rows, .columns = columns, .stride = columns };
    if (area(host, rows, columns, &count)) m->at = host_alloc(host, count, sizeof *m->at);
    return m->at != NULL;
}

void matrix_f32_finish(struct host *host, struct matrix_f32 *m)
{
    host_free(host, m->at);
    *m = (struct matrix_f32){ 0 };
}

void matrix_f64_finish(struct host *host, struct matrix_f64 *m)
{
    host_free(host, m->at);
    *m = (struct matrix_f64){ 0 };
}

bool matrix_f32_copy(struct host *host, const struct matrix_f32 *from, size_t columns,
                     struct matrix_f32 *out)
{
    if (!matrix_f32_init(host, out, from->rows, columns)) return false;
    for (size_t r = 0; r < from->rows; r++)
        memcpy(out->at + r * out->stride, from->at + r * from->stride,
               from->columns * sizeof *out->at);
    return true;
}

bool matrix_f64_from_f32(struct host *host, const struct matrix_f32 *from, struct matrix_f64 *out)
{
    if (!matrix_f64_init(host, out, from->rows, from->columns)) return false;
    for (size_t r = 0; r < from->rows; r++)
        for (size_t c = 0; c < from->columns; c++)
            out->at[r * out->stride + c] = (double)from->at[r * from->stride + c];
    return true;
}

struct matrix_f32 matrix_f32_block(const struct matrix_f32 *m, size_t first_row,
                                   size_t first_column, size_t rows, size_t columns)
{
    assert(rows <= m->rows && first_row <= m->rows - rows);
    assert(columns <= m->columns && first_column <= m->columns - columns);
    return (struct matrix_f32){ m->at + first_row * m->stride + first_column, rows, columns,
                                m->stride };
}

struct matrix_f64 matrix_f64_block(const struct matrix_f64 *m, size_t first_row,
                                   size_t first_column, size_t rows, size_t columns)
{
    assert(rows <= m->rows && first_row <= m->rows - rows);
    assert(columns <= m->columns && first_column <= m->columns - columns);
    return (struct matrix_f64){ m->at + first_row * m->stride + first_column, rows, columns,
                                m->stride };
}

double matrix_f32_norm(const struct matrix_f32 *a)
{
    double sum = 0.0;
    for (size_t r = 0; r < a->rows; r++)
        for (size_t c = 0; c < a->columns; c++) {
            const double value = (double)a->at[r * a->stride + c];
            sum += value * value;
        }
    return sqrt(sum);
}

double matrix_f64_norm(const struct matrix_f64 *a)
{
    double sum = 0.0;
    for (size_t r = 0; r < a->rows; r++)
        for (size_t c = 0; c < a->columns; c++)
            sum += a->at[r * a->stride + c] * a->at[r * a->stride + c];
    return sqrt(sum);
}

// ---- products

// The sizes of a product as BLAS takes them.
struct product {
    int m, n, k;
    int stride_a, stride_b, stride_out;
    enum CBLAS_TRANSPOSE op_a, op_b;
};

struct shape {
    size_t rows, columns, stride;
};

static struct shape transposed_shape(struct shape shape, enum transposed op)
{
    return op == TRANSPOSED ? (struct shape){ shape.columns, shape.rows, shape.stride } : shape;
}

// BLAS wants strides of at least 1, also of empty matrices.
static bool blas_stride(size_t stride, int *out)
{
    *out = stride > 0 && stride <= INT_MAX ? (int)stride : 1;
    return stride <= INT_MAX;
}

static bool plan_product(struct host *host, struct shape a, enum transposed op_a, struct shape b,
                         enum transposed op_b, struct shape out, struct product *plan)
{
    const struct shape ta = transposed_shape(a, op_a), tb = transposed_shape(b, op_b);
    if (ta.columns != tb.rows || ta.rows != out.rows || tb.columns != out.columns)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot multiply %zu x %zu by %zu x %zu into %zu x %zu: "
                         "the shapes do not fit",
                         ta.rows, ta.columns, tb.rows, tb.columns, out.rows, out.columns);
    if (!blas_stride(a.stride, &plan->stride_a) || !blas_stride(b.stride, &plan->stride_b) ||
        !blas_stride(out.stride, &plan->stride_out) || ta.rows > INT_MAX || tb.columns > INT_MAX ||
        ta.columns > INT_MAX)
        return host_fail(host, FAIL_ARGUMENT, "cannot multiply matrices of more than %d rows",
                         INT_MAX);
    plan->m = (int)ta.rows;
    plan->n = (int)tb.columns;
    plan->k = (int)ta.columns;
    plan->op_a = op_a == TRANSPOSED ? CblasTrans : CblasNoTrans;
    plan->op_b = op_b == TRANSPOSED ? CblasTrans : CblasNoTrans;
    return true;
}

#define SHAPE(m) ((struct shape){ (m)->rows, (m)->columns, (m)->stride })

bool matrix_f32_multiply(struct host *host, float alpha, const struct matrix_f32 *a,
                         enum transposed op_a, const struct matrix_f32 *b, enum transposed op_b,
                         float beta, struct matrix_f32 *out)
{
    struct product p = { 0 };
    if (!plan_product(host, SHAPE(a), op_a, SHAPE(b), op_b, SHAPE(out), &p)) return false;
    linalg_one_thread_begin();
    cblas_sgemm(CblasRowMajor, p.op_a, p.op_b, p.m, p.n, p.k, alpha, a->at, p.stride_a, b->at,
                p.stride_b, beta, out->at, p.stride_out);
    linalg_one_thread_end();
    return true;
}

bool matrix_f64_multiply(struct host *host, double alpha, const struct matrix_f64 *a,
                         enum transposed op_a, const struct matrix_f64 *b, enum transposed op_b,
                         double beta, struct matrix_f64 *out)
{
    struct product p = { 0 };
    if (!plan_product(host, SHAPE(a), op_a, SHAPE(b), op_b, SHAPE(out), &p)) return false;
    linalg_one_thread_begin();
    cblas_dgemm(CblasRowMajor, p.op_a, p.op_b, p.m, p.n, p.k, alpha, a->at, p.stride_a, b->at,
                p.stride_b, beta, out->at, p.stride_out);
    linalg_one_thread_end();
    return true;
}

double matrix_f64_orthonormality(struct host *host, const struct matrix_f64 *a)
{
    struct matrix_f64 gram = { 0 };
    double norm = (double)NAN;
    if (matrix_f64_init(host, &gram, a->columns, a->columns) &&
        matrix_f64_multiply(host, 1.0, a, TRANSPOSED, a, NOT_TRANSPOSED, 0.0, &gram)) {
        for (size_t i = 0; i < a->columns; i++) gram.at[i * gram.stride + i] -= 1.0;
        norm = matrix_f64_norm(&gram);
    }
    matrix_f64_finish(host, &gram);
    return norm;
}

// ---- decompositions

// Some BLAS kernels peel loops up to an aligned address, which changes the order of their sums:
// matrices and workspace given to LAPACK begin at a multiple of this.
enum { ALIGNMENT = 64 };

struct aligned {
    void *block; // to free
    double *at;
};

static bool aligned_init(struct host *host, struct aligned *out, size_t count)
{
    size_t bytes = 0;
    *out = (struct aligned){ 0 };
    if (!size_mul(count, sizeof(double), &bytes) || !size_add(bytes, ALIGNMENT, &bytes))
        bytes = SIZE_MAX; // host_alloc fails
    out->block = host_alloc(host, bytes, 1);
    if (!out->block) return false;
    const size_t beyond = (uintptr_t)out->block % ALIGNMENT;
    out->at = (double *)((char *)out->block + (ALIGNMENT - beyond));
    return true;
}

// A contiguous copy, refused where an element is not finite.
static bool copy_finite(struct host *host, const char *what, const struct matrix_f64 *a,
                        struct aligned *out)
{
    size_t count = 0;
    if (!area(host, a->rows, a->columns, &count) || !aligned_init(host, out, count)) return false;
    for (size_t r = 0; r < a->rows; r++)
        for (size_t c = 0; c < a->columns; c++) {
            const double value = a->at[r * a->stride + c];
            if (!isfinite(value))
                return host_fail(host, FAIL_ARGUMENT,
                                 "cannot decompose %s: element (%zu, %zu) is not finite", what, r,
                                 c);
            out->at[r * a->columns + c] = value;
        }
    return true;
}

static bool fail_lapack(struct host *host, const char *what, lapack_int info)
{
    return host_fail(host, FAIL_UNSUPPORTED, "cannot decompose %s: LAPACK did not converge (%d)",
                     what, (int)info);
}

// The sign that makes the largest component of a column positive. Components whose magnitudes are
// equal but for rounding count as equal, so that a symmetric vector keeps one sign everywhere.
static double column_sign(const struct matrix_f64 *m, size_t column)
{
    static const double EQUAL = 1.0 - 1e-9;
    double largest = 0.0;
    for (size_t r = 0; r < m->rows; r++)
        largest = fmax(largest, fabs(m->at[r * m->stride + column]));
    for (size_t r = 0; r < m->rows; r++) {
        const double value = m->at[r * m->stride + column];
        if (fabs(value) >= EQUAL * largest) return value < 0.0 ? -1.0 : 1.0;
    }
    return 1.0;
}

static void negate(double *at, size_t count, size_t step)
{
    for (size_t i = 0; i < count; i++) at[i * step] = -at[i * step];
}

static void fix_signs(struct linalg_svd *svd)
{
    for (size_t i = 0; i < svd->count; i++) {
        if (column_sign(&svd->u, i) > 0.0) continue;
        negate(svd->u.at + i, svd->u.rows, svd->u.stride);
        negate(svd->vt.at + i * svd->vt.stride, svd->vt.columns, 1);
    }
}

// Outputs and scratch memory of gesdd: m, n and k are those of the row-major matrix.
struct svd_work {
    struct aligned a, u, vt, work;
    lapack_int *integers; // 8k
};

static void svd_work_finish(struct host *host, struct svd_work *w)
{
    host_free(host, w->a.block);
    host_free(host, w->u.block);
    host_free(host, w->vt.block);
    host_free(host, w->work.block);
    host_free(host, w->integers);
}

static lapack_int call_gesdd(struct svd_work *w, const struct linalg_svd *svd, double *work,
                             lapack_int work_size)
{
    const lapack_int m = (lapack_int)svd->u.rows, n = (lapack_int)svd->vt.columns;
    const lapack_int k = (lapack_int)svd->count;
    linalg_one_thread_begin();
    const lapack_int info =
        LAPACKE_dgesdd_work(LAPACK_COL_MAJOR, 'S', n, m, w->a.at, n, svd->sigma, w->vt.at, n,
                            w->u.at, k, work, work_size, w->integers);
    linalg_one_thread_end();
    return info;
}

static bool run_gesdd(struct host *host, const char *what, struct svd_work *w,
                      struct linalg_svd *svd)
{
    double wanted = 0.0;
    const size_t k = svd->count;
    w->integers = host_alloc(host, 8 * k, sizeof *w->integers);
    if (!w->integers || !aligned_init(host, &w->u, svd->u.rows * k) ||
        !aligned_init(host, &w->vt, k * svd->vt.columns))
        return false;
    lapack_int info = call_gesdd(w, svd, &wanted, -1);
    if (info != 0 || wanted > (double)INT_MAX) return fail_lapack(host, what, info);
    if (!aligned_init(host, &w->work, (size_t)wanted)) return false;
    info = call_gesdd(w, svd, w->work.at, (lapack_int)wanted);
    if (info != 0) return fail_lapack(host, what, info);
    memcpy(svd->u.at, w->u.at, svd->u.rows * k * sizeof(double));
    memcpy(svd->vt.at, w->vt.at, k * svd->vt.columns * sizeof(double));
    fix_signs(svd);
    return true;
}

bool linalg_svd(struct host *host, const char *what, const struct matrix_f64 *a,
                struct linalg_svd *out)
{
    struct svd_work work = { 0 };
    const size_t k = a->rows < a->columns ? a->rows : a->columns;
    *out = (struct linalg_svd){ .count = k };
    bool ok = matrix_f64_init(host, &out->u, a->rows, k) &&
              matrix_f64_init(host, &out->vt, k, a->columns);
    if (ok) out->sigma = host_alloc(host, k, sizeof *out->sigma);
    ok = ok && out->sigma && copy_finite(host, what, a, &work.a);
    if (ok && k > 0) ok = run_gesdd(host, what, &work, out);
    svd_work_finish(host, &work);
    if (!ok) linalg_svd_finish(host, out);
    return ok;
}

void linalg_svd_finish(struct host *host, struct linalg_svd *svd)
{
    matrix_f64_finish(host, &svd->u);
    matrix_f64_finish(host, &svd->vt);
    host_free(host, svd->sigma);
    *svd = (struct linalg_svd){ 0 };
}

// syev's rows are the eigenvectors of ascending values; the columns of `out` descend.
static void copy_eigen(const double *rows, const double *ascending, struct linalg_eigen *out)
{
    const size_t n = out->vectors.rows;
    for (size_t i = 0; i < n; i++) {
        out->values[i] = ascending[n - 1 - i];
        for (size_t r = 0; r < n; r++) out->vectors.at[r * n + i] = rows[(n - 1 - i) * n + r];
    }
    for (size_t i = 0; i < n; i++)
        if (column_sign(&out->vectors, i) < 0.0) negate(out->vectors.at + i, n, n);
}

// 'U' of the column-major transpose is the lower triangle of the row-major matrix.
static lapack_int call_syev(double *a, size_t n, double *values, double *work, lapack_int work_size)
{
    const lapack_int size = (lapack_int)n;
    linalg_one_thread_begin();
    const lapack_int info =
        LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'U', size, a, size, values, work, work_size);
    linalg_one_thread_end();
    return info;
}

static bool run_syev(struct host *host, const char *what, struct aligned *a,
                     struct linalg_eigen *out)
{
    struct aligned values = { 0 }, work = { 0 };
    double wanted = 0.0;
    const size_t n = out->vectors.rows;
    lapack_int info = call_syev(a->at, n, NULL, &wanted, -1);
    if (info != 0 || wanted > (double)INT_MAX) return fail_lapack(host, what, info);
    bool ok = aligned_init(host, &values, n) && aligned_init(host, &work, (size_t)wanted);
    if (ok) info = call_syev(a->at, n, values.at, work.at, (lapack_int)wanted);
    if (info != 0) ok = fail_lapack(host, what, info);
    if (ok) copy_eigen(a->at, values.at, out);
    host_free(host, values.block);
    host_free(host, work.block);
    return ok;
}

bool linalg_symmetric_eigen(struct host *host, const char *what, const struct matrix_f64 *a,
                            struct linalg_eigen *out)
{
    struct aligned copy = { 0 };
    *out = (struct linalg_eigen){ 0 };
    if (a->rows != a->columns)
        return host_fail(host, FAIL_ARGUMENT, "cannot decompose %s: %zu x %zu is not square", what,
                         a->rows, a->columns);
    bool ok = matrix_f64_init(host, &out->vectors, a->rows, a->rows);
    if (ok) out->values = host_alloc(host, a->rows, sizeof *out->values);
    ok = ok && out->values && copy_finite(host, what, a, &copy);
    if (ok && a->rows > 0) ok = run_syev(host, what, &copy, out);
    host_free(host, copy.block);
    if (!ok) linalg_eigen_finish(host, out);
    return ok;
}

void linalg_eigen_finish(struct host *host, struct linalg_eigen *eigen)
{
    matrix_f64_finish(host, &eigen->vectors);
    host_free(host, eigen->values);
    *eigen = (struct linalg_eigen){ 0 };
}
