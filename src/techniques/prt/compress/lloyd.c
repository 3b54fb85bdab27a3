// The two steps of a round: points to clusters, clusters to points.
#include "techniques/prt/compress/compress.h"

#include "core/linalg.h"

#include <math.h>
#include <string.h>

// ---- points to clusters

// Products of all rows of a codebook with their means: with a mean m and vectors b, |m|² and b·m.
struct norms {
    float *of; // [clusters][1 + vectors]
};

static float dot(const float *a, const float *b, size_t dim)
{
    double sum = 0.0;
    for (size_t i = 0; i < dim; i++) sum += (double)a[i] * (double)b[i];
    return (float)sum;
}

static bool find_norms(const struct prt_codebook *book, struct norms *out)
{
    out->of = host_alloc(book->host, book->clusters * (1 + book->vectors), sizeof *out->of);
    if (!out->of) return false;
    for (size_t c = 0; c < book->clusters; c++)
        for (size_t k = 0; k <= book->vectors; k++)
            out->of[c * (1 + book->vectors) + k] =
                dot(prt_codebook_row(book, c, 0), prt_codebook_row(book, c, k), book->dim);
    return true;
}

// |x − m|² − Σ (b·(x − m))², from products of x with the rows.
static float subspace_distance(const float *products, const float *norms, size_t vectors, float xx)
{
    float sum = xx - 2.0f * products[0] + norms[0];
    for (size_t k = 1; k <= vectors; k++) {
        const float w = products[k] - norms[k];
        sum -= w * w;
    }
    return sum;
}

static void assign_point(const struct prt_codebook *book, const struct norms *norms,
                         const float *products, float xx, uint32_t *cluster, float *error)
{
    const size_t rows = 1 + book->vectors;
    float least = INFINITY;
    for (size_t c = 0; c < book->clusters; c++) {
        const float distance =
            subspace_distance(products + c * rows, norms->of + c * rows, book->vectors, xx);
        if (!(distance < least)) continue;
        least = distance;
        *cluster = (uint32_t)c;
    }
    *error = fmaxf(least, 0.0f);
}

static bool assign_block(const struct prt_points *points, size_t first, struct matrix_f32 *block,
                         const struct matrix_f32 *rows, const struct norms *norms,
                         struct prt_codebook *book, float *error)
{
    const size_t dim = points->dim;
    const struct matrix_f32 x = { (float *)points->at + first * dim, block->rows, dim, dim };
    if (!matrix_f32_multiply(book->host, 1, &x, NOT_TRANSPOSED, rows, TRANSPOSED, 0, block))
        return false;
    for (size_t i = 0; i < block->rows; i++) {
        const float *at = x.at + i * dim;
        assign_point(book, norms, block->at + i * block->stride, dot(at, at, dim),
                     &book->cluster[first + i], &error[first + i]);
    }
    return true;
}

bool prt_assign(const struct prt_points *points, const struct prt_compression *how,
                struct prt_codebook *book, float *error)
{
    enum { MOST_PRODUCTS = 1 << 20, LEAST_POINTS = 16 };
    const size_t count = book->clusters * (1 + book->vectors);
    const size_t most = MOST_PRODUCTS / count > LEAST_POINTS ? MOST_PRODUCTS / count : LEAST_POINTS;
    const struct matrix_f32 rows = { book->rows, count, book->dim, book->dim };
    struct matrix_f32 products = { 0 };
    struct norms norms = { 0 };
    bool ok = matrix_f32_init(book->host, &products, most, count) && find_norms(book, &norms);
    for (size_t first = 0; ok && first < points->count; first += most) {
        const size_t left = points->count - first;
        struct matrix_f32 block =
            matrix_f32_block(&products, 0, 0, left < most ? left : most, count);
        ok = !prt_stopped(book->host, how) &&
             assign_block(points, first, &block, &rows, &norms, book, error);
    }
    matrix_f32_finish(book->host, &products);
    host_free(book->host, norms.of);
    return ok;
}

// ---- clusters to points

// Points sorted by cluster, in their order.
struct members {
    size_t *first; // [clusters + 1]
    size_t *of;    // [points]
};

static bool find_members(const struct prt_points *points, const struct prt_codebook *book,
                         struct members *out)
{
    out->first = host_alloc(book->host, book->clusters + 2, sizeof *out->first);
    out->of = host_alloc(book->host, points->count, sizeof *out->of);
    if (!out->first || !out->of) return false;
    for (size_t i = 0; i < points->count; i++) out->first[book->cluster[i] + 2]++;
    for (size_t c = 0; c < book->clusters; c++) out->first[c + 2] += out->first[c + 1];
    // The entry after a cluster's counts up to the beginning of the next one.
    for (size_t i = 0; i < points->count; i++) out->of[out->first[book->cluster[i] + 1]++] = i;
    return true;
}

static void update_mean(const struct prt_points *points, const size_t *member, size_t count,
                        float *mean)
{
    for (size_t d = 0; d < points->dim; d++) {
        double sum = 0.0;
        for (size_t i = 0; i < count; i++) sum += (double)points->at[member[i] * points->dim + d];
        mean[d] = (float)(sum / (double)count);
    }
}

// Σ (x − m)(x − m)ᵀ over the members, a block of them at a time.
static bool find_scatter(const struct prt_points *points, const size_t *member, size_t count,
                         struct host *host, const float *mean, struct matrix_f64 *scatter)
{
    enum { BLOCK = 1024 };
    const size_t dim = points->dim;
    struct matrix_f64 x = { 0 };
    bool ok = matrix_f64_init(host, &x, count < BLOCK ? count : BLOCK, dim) &&
              matrix_f64_init(host, scatter, dim, dim);
    for (size_t first = 0; ok && first < count; first += BLOCK) {
        const size_t left = count - first, rows = left < BLOCK ? left : BLOCK;
        const struct matrix_f64 block = matrix_f64_block(&x, 0, 0, rows, dim);
        for (size_t i = 0; i < rows; i++)
            for (size_t d = 0; d < dim; d++)
                block.at[i * dim + d] = (double)(points->at[member[first + i] * dim + d] - mean[d]);
        ok = matrix_f64_multiply(host, 1, &block, TRANSPOSED, &block, NOT_TRANSPOSED, 1, scatter);
    }
    matrix_f64_finish(host, &x);
    return ok;
}

// Columns are eigenvectors by descending variance. Few of many are found without the others.
static bool find_eigenvectors(struct host *host, const struct matrix_f64 *scatter, size_t count,
                              struct matrix_f64 *out)
{
    enum { MOST_WHOLE = 128 };
    static const char WHAT[] = "scatter of transfer vectors";
    if (scatter->rows > MOST_WHOLE) {
        const struct linalg_truncation truncation = { 1.0, count, 0 };
        return linalg_truncated_left(host, WHAT, scatter, &truncation, out);
    }
    struct linalg_eigen eigen = { 0 };
    if (!linalg_symmetric_eigen(host, WHAT, scatter, &eigen)) return false;
    *out = eigen.vectors;
    eigen.vectors = (struct matrix_f64){ 0 };
    linalg_eigen_finish(host, &eigen);
    return true;
}

// Vectors beyond the rank of the members are 0.
static bool update_vectors(const struct prt_points *points, const size_t *member, size_t count,
                           struct prt_codebook *book, float *mean)
{
    const size_t dim = book->dim;
    struct matrix_f64 scatter = { 0 };
    struct matrix_f64 vectors = { 0 };
    const bool ok = find_scatter(points, member, count, book->host, mean, &scatter) &&
                    find_eigenvectors(book->host, &scatter, book->vectors, &vectors);
    for (size_t k = 0; ok && k < book->vectors; k++)
        for (size_t d = 0; d < dim; d++)
            mean[(1 + k) * dim + d] =
                k < vectors.columns ? (float)vectors.at[d * vectors.stride + k] : 0.0f;
    matrix_f64_finish(book->host, &vectors);
    matrix_f64_finish(book->host, &scatter);
    return ok;
}

bool prt_update(const struct prt_points *points, struct prt_codebook *book)
{
    struct members members = { 0 };
    bool ok = find_members(points, book, &members);
    for (size_t c = 0; ok && c < book->clusters; c++) {
        float *mean = book->rows + c * (1 + book->vectors) * book->dim;
        const size_t *member = members.of + members.first[c];
        const size_t count = members.first[c + 1] - members.first[c];
        if (count == 0) continue;
        update_mean(points, member, count, mean);
        if (book->vectors > 0) ok = update_vectors(points, member, count, book, mean);
    }
    host_free(book->host, members.first);
    host_free(book->host, members.of);
    return ok;
}
