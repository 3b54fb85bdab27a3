// Compression of points by clusters of affine subspaces.
#include "framework/test.h"

#include "core/linalg.h"
#include "core/rng.h"
#include "techniques/prt/compress/compress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DIM = 12, SPREAD = 10 };

// Points of `groups` groups, each near a subspace of 2 dimensions of its own.
static struct prt_points make_points(size_t count, size_t groups, float noise)
{
    float *at = calloc(count * DIM, sizeof *at);
    assert_non_null(at);
    for (size_t i = 0; i < count; i++) {
        struct rng group = rng_for((uint32_t)(i % groups), 1, 0), own = rng_for((uint32_t)i, 2, 0);
        const float u = 2 * rng_float(&own) - 1, v = 2 * rng_float(&own) - 1;
        for (size_t d = 0; d < DIM; d++) {
            const float mean = SPREAD * rng_float(&group), a = rng_float(&group) - 0.5f,
                        b = rng_float(&group) - 0.5f;
            at[i * DIM + d] = mean + u * a + v * b + noise * (rng_float(&own) - 0.5f);
        }
    }
    return (struct prt_points){ at, count, DIM };
}

static void points_finish(struct prt_points *points)
{
    free((float *)points->at);
}

// By the weights of each point.
static double error_of(const struct prt_points *points, const struct prt_codebook *book)
{
    double sum = 0;
    for (size_t i = 0; i < points->count; i++) {
        float weights[DIM];
        prt_weigh(book, book->cluster[i], points->at + i * points->dim, weights);
        for (size_t d = 0; d < points->dim; d++) {
            double x = (double)prt_codebook_row(book, book->cluster[i], 0)[d];
            for (size_t k = 0; k < book->vectors; k++)
                x += (double)(weights[k] * prt_codebook_row(book, book->cluster[i], 1 + k)[d]);
            const double off = x - (double)points->at[i * points->dim + d];
            sum += off * off;
        }
    }
    return sum;
}

static double relative_error(const struct prt_points *points, uint32_t clusters, uint32_t vectors)
{
    struct prt_codebook book;
    const struct prt_compression how = { .clusters = clusters, .vectors = vectors, .seed = 5 };
    CHECK(prt_compress(test_host(), points, &how, &book));
    const double error = error_of(points, &book), all = prt_variance(points);
    CHECK_NEAR(book.error / all, error / all, 1e-5);
    prt_codebook_finish(&book);
    return error / all;
}

TEST(all_principal_components_reproduce_the_points)
{
    struct prt_points points = make_points(500, 5, 0.1f);
    CHECK(relative_error(&points, 1, DIM) < 1e-10);
    CHECK(relative_error(&points, 7, DIM) < 1e-10);
    double last = 1;
    for (uint32_t k = 1; k < DIM; k++) {
        const double error = relative_error(&points, 1, k);
        CHECK(error < last);
        last = error;
    }
    points_finish(&points);
}

TEST(without_vectors_one_cluster_has_the_variance)
{
    struct prt_points points = make_points(300, 3, 0.1f);
    CHECK_NEAR(relative_error(&points, 1, 0), 1, 1e-6);
    points_finish(&points);
}

// Eight groups of two dimensions.
TEST(clusters_find_the_subspaces_of_the_points)
{
    struct prt_points points = make_points(2000, 8, 0);
    const double cpca = relative_error(&points, 8, 2), vq = relative_error(&points, 8, 0),
                 pca = relative_error(&points, 1, 2);
    print_message("relative error: clusters of subspaces %.2g, of points %.2g, one subspace %.2g\n",
                  cpca, vq, pca);
    CHECK(cpca < 1e-6 && vq < 0.1 && pca < 1);
    points_finish(&points);
}

// The same points by a linear map to many numbers.
static struct prt_points widened(const struct prt_points *from, size_t dim)
{
    float *at = calloc(from->count * dim, sizeof *at);
    assert_non_null(at);
    for (size_t d = 0; d < dim; d++) {
        struct rng rng = rng_for((uint32_t)d, 3, 0);
        float row[DIM];
        for (size_t k = 0; k < DIM; k++) row[k] = 2 * rng_float(&rng) - 1;
        for (size_t i = 0; i < from->count; i++)
            for (size_t k = 0; k < DIM; k++)
                at[i * dim + d] += row[k] * from->at[i * from->dim + k];
    }
    return (struct prt_points){ at, from->count, dim };
}

// Points of more than 128 numbers are clustered in fewer.
TEST(clusters_of_many_numbers_find_the_subspaces_of_the_points)
{
    struct prt_points narrow = make_points(2000, 8, 0), wide = widened(&narrow, 300);
    struct prt_codebook book;
    const struct prt_compression how = { .clusters = 8, .vectors = 2, .seed = 5 };
    CHECK(prt_compress(test_host(), &wide, &how, &book));
    CHECK(book.dim == 300);
    double error = 0;
    for (size_t i = 0; i < wide.count; i++) {
        const float *mean = prt_codebook_row(&book, book.cluster[i], 0);
        float weights[2];
        prt_weigh(&book, book.cluster[i], wide.at + i * wide.dim, weights);
        for (size_t d = 0; d < wide.dim; d++) {
            const float x = mean[d] + weights[0] * mean[wide.dim + d] +
                            weights[1] * mean[2 * wide.dim + d] - wide.at[i * wide.dim + d];
            error += (double)(x * x);
        }
    }
    error /= prt_variance(&wide);
    print_message("relative error: %.2g\n", error);
    CHECK(error < 1e-6);
    prt_codebook_finish(&book);
    points_finish(&wide);
    points_finish(&narrow);
}

static size_t bytes_of(size_t points, size_t clusters, size_t vectors)
{
    return 2 * (points * (vectors + (clusters > 1)) + clusters * (1 + vectors) * DIM);
}

// More clusters than groups: Lloyd's rounds may leave two groups in one.
TEST(clustered_components_are_better_than_both_at_equal_bytes)
{
    enum { CLUSTERS = 40 };
    struct prt_points points = make_points(4000, 24, 0.05f);
    const size_t bytes = bytes_of(points.count, CLUSTERS, 2);
    const double cpca = relative_error(&points, CLUSTERS, 2), pca = relative_error(&points, 1, 4);
    uint32_t clusters = CLUSTERS;
    while (bytes_of(points.count, clusters + 1, 0) <= bytes) clusters++;
    const double vq = relative_error(&points, clusters, 0);
    print_message("relative error: cpca %.3g, pca %.3g, vq %.3g of %u clusters\n", cpca, pca, vq,
                  clusters);
    CHECK(bytes_of(points.count, 1, 4) >= bytes && cpca < pca && cpca < vq);
    points_finish(&points);
}

TEST(vectors_of_a_cluster_are_orthonormal)
{
    struct prt_points points = make_points(700, 4, 0.2f);
    struct prt_codebook book;
    CHECK(prt_compress(test_host(), &points,
                       &(struct prt_compression){ .clusters = 5, .vectors = 4 }, &book));
    for (size_t c = 0; c < 5; c++)
        for (size_t i = 1; i <= 4; i++)
            for (size_t j = 1; j <= 4; j++) {
                double dot = 0;
                for (size_t d = 0; d < DIM; d++)
                    dot += (double)(prt_codebook_row(&book, c, i)[d] *
                                    prt_codebook_row(&book, c, j)[d]);
                CHECK_NEAR(dot, i == j ? 1.0 : 0.0, 1e-5);
            }
    prt_codebook_finish(&book);
    points_finish(&points);
}

TEST(the_same_seed_gives_the_same_bytes)
{
    struct prt_points points = make_points(1500, 10, 0.5f);
    struct prt_codebook a, b;
    const struct prt_compression how = { .clusters = 16, .vectors = 3, .seed = 9 };
    CHECK(prt_compress(test_host(), &points, &how, &a) &&
          prt_compress(test_host(), &points, &how, &b));
    CHECK(memcmp(a.rows, b.rows, (size_t)16 * 4 * DIM * sizeof *a.rows) == 0);
    CHECK(memcmp(a.cluster, b.cluster, points.count * sizeof *a.cluster) == 0);
    prt_codebook_finish(&a);
    prt_codebook_finish(&b);
    points_finish(&points);
}

// Fewer different points than clusters, one point, and none.
TEST(clusters_may_be_empty)
{
    struct prt_points points = make_points(40, 2, 0);
    float *at = (float *)points.at;
    for (size_t i = 2; i < points.count; i++)
        memcpy(at + i * DIM, at + i % 2 * DIM, DIM * sizeof *at);
    CHECK(relative_error(&points, 16, 0) < 1e-10 && relative_error(&points, 16, 3) < 1e-10);
    points.count = 1;
    struct prt_codebook book;
    CHECK(prt_compress(test_host(), &points,
                       &(struct prt_compression){ .clusters = 4, .vectors = 2 }, &book));
    CHECK(book.error < 1e-10);
    prt_codebook_finish(&book);
    points.count = 0;
    CHECK(prt_compress(test_host(), &points,
                       &(struct prt_compression){ .clusters = 4, .vectors = 2 }, &book));
    prt_codebook_finish(&book);
    points_finish(&points);
}

static bool stop(void *user)
{
    return --*(int *)user < 0;
}

TEST(compression_stops_where_it_is_told)
{
    struct prt_points points = make_points(2000, 30, 1);
    struct prt_codebook book;
    for (int polls = 0; polls < 40; polls += 9) {
        int left = polls;
        CHECK(!prt_compress(test_host(), &points,
                            &(struct prt_compression){ 32, 2, 0, stop, &left }, &book));
        CHECK(test_host()->failure == FAIL_CANCELLED);
        prt_codebook_finish(&book);
    }
    points_finish(&points);
}
