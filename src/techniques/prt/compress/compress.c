#include "techniques/prt/compress/compress.h"

#include <math.h>
#include <string.h>

void prt_codebook_finish(struct prt_codebook *book)
{
    if (!book->host) return;
    host_free(book->host, book->rows);
    host_free(book->host, book->cluster);
    *book = (struct prt_codebook){ 0 };
}

static bool codebook_init(struct prt_codebook *book, struct host *host,
                          const struct prt_points *points, size_t clusters, size_t vectors)
{
    *book = (struct prt_codebook){
        .host = host, .clusters = clusters, .vectors = vectors, .dim = points->dim
    };
    book->rows = host_alloc(host, clusters * (1 + vectors), points->dim * sizeof *book->rows);
    book->cluster = host_alloc(host, points->count, sizeof *book->cluster);
    return book->rows && book->cluster;
}

// An empty cluster gets the point that is farthest from its own.
static bool fill_empty(const struct prt_points *points, struct prt_codebook *book, float *error)
{
    size_t *count = host_alloc(book->host, book->clusters, sizeof *count);
    if (!count) return false;
    for (size_t i = 0; i < points->count; i++) count[book->cluster[i]]++;
    for (size_t c = 0; c < book->clusters; c++) {
        size_t farthest = 0;
        if (count[c] > 0) continue;
        for (size_t i = 1; i < points->count; i++)
            if (error[i] > error[farthest]) farthest = i;
        if (!(error[farthest] > 0.0f)) break;
        count[book->cluster[farthest]]--;
        count[c]++;
        book->cluster[farthest] = (uint32_t)c;
        error[farthest] = 0.0f;
    }
    host_free(book->host, count);
    return true;
}

static double sum_of(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)values[i];
    return sum;
}

// Rounds until the error falls by less than a ten-thousandth. `error`: of the last one.
static bool run_rounds(const struct prt_points *points, const struct prt_compression *how,
                       struct prt_codebook *book, float *error)
{
    enum { MOST_ROUNDS = 20 };
    static const double STABLE = 1e-4;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const double before = book->error;
        if (!prt_assign(points, how, book, error)) return false;
        book->error = sum_of(error, points->count);
        if (!fill_empty(points, book, error) || !prt_update(points, book)) return false;
        if (round > 0 && book->error >= before * (1.0 - STABLE)) break;
    }
    return true;
}

// A codebook with the same clusters and vectors of their points.
static bool add_vectors(const struct prt_points *points, size_t vectors, struct prt_codebook *book)
{
    struct prt_codebook more;
    bool ok = codebook_init(&more, book->host, points, book->clusters, vectors);
    if (ok) memcpy(more.cluster, book->cluster, points->count * sizeof *more.cluster);
    ok = ok && prt_update(points, &more);
    prt_codebook_finish(book);
    *book = more;
    return ok;
}

// The last round has changed the subspaces.
static bool settle(const struct prt_points *points, const struct prt_compression *how,
                   struct prt_codebook *book, float *error)
{
    if (!prt_assign(points, how, book, error)) return false;
    book->error = sum_of(error, points->count);
    return true;
}

static bool compress(const struct prt_points *points, const struct prt_compression *how,
                     struct prt_codebook *book, float *error)
{
    if (how->clusters > 1 &&
        (!prt_find_seeds(points, how, book) || !run_rounds(points, how, book, error)))
        return false;
    if (how->clusters == 1 && !prt_update(points, book)) return false;
    if (how->vectors > 0 && !add_vectors(points, how->vectors, book)) return false;
    if (how->vectors > 0 && how->clusters > 1 && !run_rounds(points, how, book, error))
        return false;
    return settle(points, how, book, error);
}

static void find_mean(const struct prt_points *points, float *mean)
{
    for (size_t d = 0; d < points->dim; d++) {
        double sum = 0.0;
        for (size_t i = 0; i < points->count; i++) sum += (double)points->at[i * points->dim + d];
        mean[d] = (float)(sum / (double)points->count);
    }
}

static void move_means(struct prt_codebook *book, const float *by)
{
    for (size_t c = 0; c < book->clusters; c++)
        for (size_t d = 0; d < book->dim; d++)
            book->rows[c * (1 + book->vectors) * book->dim + d] += by[d];
}

static bool compress_reduced(const struct prt_points *centred, const struct prt_compression *how,
                             struct host *host, struct prt_codebook *out, float *error)
{
    struct prt_reduction reduction = { 0 };
    bool ok = prt_reduce(host, centred, how, &reduction);
    const struct matrix_f32 *less = &reduction.points;
    const struct prt_points reduced = { less->at, less->rows, less->columns };
    const struct prt_points *points = less->at ? &reduced : centred;
    ok = ok && codebook_init(out, host, points, how->clusters, 0) &&
         compress(points, how, out, error);
    if (ok && less->at) ok = prt_expand(&reduction, out) && prt_update(centred, out);
    prt_reduction_finish(&reduction);
    return ok;
}

// Distances are differences of squares: small around the mean of all points.
bool prt_compress(struct host *host, const struct prt_points *points,
                  const struct prt_compression *how, struct prt_codebook *out)
{
    const size_t dim = points->dim;
    float *mean = host_alloc(host, dim, sizeof *mean);
    float *moved = host_alloc(host, points->count, dim * sizeof *moved);
    float *error = host_alloc(host, points->count, sizeof *error);
    const struct prt_points centred = { moved, points->count, dim };
    bool ok = mean && moved && error;
    if (ok && points->count == 0) ok = codebook_init(out, host, points, how->clusters, 0);
    if (ok && points->count > 0) {
        find_mean(points, mean);
        for (size_t i = 0; i < points->count * dim; i++) moved[i] = points->at[i] - mean[i % dim];
        ok = compress_reduced(&centred, how, host, out, error);
        if (ok) move_means(out, mean);
    }
    host_free(host, mean);
    host_free(host, moved);
    host_free(host, error);
    return ok;
}

void prt_weigh(const struct prt_codebook *book, uint32_t cluster, const float *point,
               float *weights)
{
    const float *mean = prt_codebook_row(book, cluster, 0);
    for (size_t k = 0; k < book->vectors; k++) {
        const float *vector = prt_codebook_row(book, cluster, 1 + k);
        double sum = 0.0;
        for (size_t d = 0; d < book->dim; d++)
            sum += (double)vector[d] * (double)(point[d] - mean[d]);
        weights[k] = (float)sum;
    }
}

double prt_variance(const struct prt_points *points)
{
    double sum = 0.0;
    for (size_t d = 0; d < points->dim; d++) {
        double first = 0.0, second = 0.0;
        for (size_t i = 0; i < points->count; i++) {
            const double x = (double)points->at[i * points->dim + d];
            first += x;
            second += x * x;
        }
        if (points->count > 0) sum += second - first * first / (double)points->count;
    }
    return fmax(sum, 0.0);
}
