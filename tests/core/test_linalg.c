// Linear algebra against matrices written by hand, and the laws that hold for any matrix.
#include "core/linalg.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "framework/test.h"

#include <math.h>
#include <string.h>

static struct matrix_f64 filled(size_t rows, size_t columns, const double *values)
{
    struct matrix_f64 m;
    CHECK(matrix_f64_init(test_host(), &m, rows, columns));
    if (rows * columns > 0) memcpy(m.at, values, rows * columns * sizeof *values);
    return m;
}

static struct matrix_f64 random_matrix(size_t rows, size_t columns, uint32_t seed)
{
    struct matrix_f64 m;
    CHECK(matrix_f64_init(test_host(), &m, rows, columns));
    struct rng rng = rng_for(seed, 0, 0);
    for (size_t i = 0; i < rows * columns; i++) m.at[i] = 2.0 * (double)rng_float(&rng) - 1.0;
    return m;
}

static double reconstruction_error(const struct matrix_f64 *a, const struct linalg_svd *svd)
{
    double worst = 0.0;
    for (size_t r = 0; r < a->rows; r++)
        for (size_t c = 0; c < a->columns; c++) {
            double sum = 0.0;
            for (size_t i = 0; i < svd->count; i++)
                sum += svd->u.at[r * svd->u.stride + i] * svd->sigma[i] *
                       svd->vt.at[i * svd->vt.stride + c];
            worst = fmax(worst, fabs(sum - a->at[r * a->stride + c]));
        }
    return worst;
}

static double row_orthonormality(const struct matrix_f64 *vt)
{
    struct matrix_f64 v;
    CHECK(matrix_f64_init(test_host(), &v, vt->columns, vt->rows));
    for (size_t r = 0; r < vt->rows; r++)
        for (size_t c = 0; c < vt->columns; c++)
            v.at[c * v.stride + r] = vt->at[r * vt->stride + c];
    const double norm = matrix_f64_orthonormality(test_host(), &v);
    matrix_f64_finish(test_host(), &v);
    return norm;
}

TEST(linalg_products_match_those_by_hand_with_every_transposition)
{
    // a is 2×3, b is 3×2; a·b = [[58, 64], [139, 154]].
    const double a_values[] = { 1, 2, 3, 4, 5, 6 }, b_values[] = { 7, 8, 9, 10, 11, 12 };
    const double at_values[] = { 1, 4, 2, 5, 3, 6 }, bt_values[] = { 7, 9, 11, 8, 10, 12 };
    struct matrix_f64 a[2] = { filled(2, 3, a_values), filled(3, 2, at_values) };
    struct matrix_f64 b[2] = { filled(3, 2, b_values), filled(2, 3, bt_values) };
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) {
            const double before[] = { 1, 1, 1, 1 };
            struct matrix_f64 out = filled(2, 2, before);
            CHECK(matrix_f64_multiply(test_host(), 2.0, &a[i], (enum transposed)i, &b[k],
                                      (enum transposed)k, -1.0, &out));
            CHECK_NEAR(out.at[0], 115.0, 0.0);
            CHECK_NEAR(out.at[1], 127.0, 0.0);
            CHECK_NEAR(out.at[2], 277.0, 0.0);
            CHECK_NEAR(out.at[3], 307.0, 0.0);
            matrix_f64_finish(test_host(), &out);
        }
    for (int i = 0; i < 2; i++) {
        matrix_f64_finish(test_host(), &a[i]);
        matrix_f64_finish(test_host(), &b[i]);
    }
}

TEST(linalg_products_of_blocks_use_the_stride_and_leave_the_rest_alone)
{
    struct matrix_f32 m, out;
    CHECK(matrix_f32_init(test_host(), &m, 4, 5) && matrix_f32_init(test_host(), &out, 3, 4));
    for (size_t i = 0; i < 20; i++) m.at[i] = (float)i;
    const struct matrix_f32 a = matrix_f32_block(&m, 1, 1, 2, 2); // [[6, 7], [11, 12]]
    const struct matrix_f32 b = matrix_f32_block(&m, 2, 3, 2, 2); // [[13, 14], [18, 19]]
    struct matrix_f32 c = matrix_f32_block(&out, 1, 2, 2, 2);
    c.at[0] = NAN; // beta 0 does not read it
    CHECK(matrix_f32_multiply(test_host(), 1.0f, &a, NOT_TRANSPOSED, &b, NOT_TRANSPOSED, 0.0f, &c));
    const float expected[] = { 0, 0, 0, 0, 0, 0, 204, 217, 0, 0, 359, 382 };
    for (size_t i = 0; i < 12; i++) CHECK_NEAR(out.at[i], expected[i], 0.0);
    matrix_f32_finish(test_host(), &m);
    matrix_f32_finish(test_host(), &out);
}

TEST(linalg_products_of_shapes_that_do_not_fit_are_refused_with_the_shapes)
{
    struct matrix_f64 a = random_matrix(2, 3, 1), b = random_matrix(2, 3, 2), out;
    CHECK(matrix_f64_init(test_host(), &out, 2, 3));
    CHECK(
        !matrix_f64_multiply(test_host(), 1.0, &a, NOT_TRANSPOSED, &b, NOT_TRANSPOSED, 0.0, &out));
    CHECK_STRING(test_last_message(),
                 "cannot multiply 2 x 3 by 2 x 3 into 2 x 3: the shapes do not fit");
    matrix_f64_finish(test_host(), &a);
    matrix_f64_finish(test_host(), &b);
    matrix_f64_finish(test_host(), &out);
}

TEST(linalg_products_over_nothing_are_zero)
{
    struct matrix_f64 a = random_matrix(2, 0, 1), b = random_matrix(0, 2, 2), out;
    out = random_matrix(2, 2, 3);
    CHECK(matrix_f64_multiply(test_host(), 1.0, &a, NOT_TRANSPOSED, &b, NOT_TRANSPOSED, 0.0, &out));
    CHECK_NEAR(matrix_f64_norm(&out), 0.0, 0.0);
    matrix_f64_finish(test_host(), &a);
    matrix_f64_finish(test_host(), &b);
    matrix_f64_finish(test_host(), &out);
}

TEST(linalg_svd_of_a_diagonal_matrix_by_hand)
{
    // 3, then −2 whose sign moves to the right vector, then 0.
    const double values[] = { 0, -2, 0, 0, 0, 0, 3, 0, 0 };
    struct matrix_f64 a = filled(3, 3, values);
    struct linalg_svd svd;
    CHECK(linalg_svd(test_host(), "a", &a, &svd));
    CHECK_NEAR(svd.sigma[0], 3.0, 1e-15);
    CHECK_NEAR(svd.sigma[1], 2.0, 1e-15);
    CHECK_NEAR(svd.sigma[2], 0.0, 1e-15);
    CHECK_NEAR(svd.u.at[2 * 3 + 0], 1.0, 1e-15);
    CHECK_NEAR(svd.vt.at[0], 1.0, 1e-15);
    CHECK_NEAR(svd.u.at[0 * 3 + 1], 1.0, 1e-15);
    CHECK_NEAR(svd.vt.at[1 * 3 + 1], -1.0, 1e-15);
    linalg_svd_finish(test_host(), &svd);
    matrix_f64_finish(test_host(), &a);
}

static void check_svd_laws(const struct matrix_f64 *a)
{
    struct linalg_svd svd;
    CHECK(linalg_svd(test_host(), "a", a, &svd));
    CHECK(svd.count == (a->rows < a->columns ? a->rows : a->columns));
    CHECK_NEAR(reconstruction_error(a, &svd), 0.0, 1e-12);
    CHECK_NEAR(matrix_f64_orthonormality(test_host(), &svd.u), 0.0, 1e-12);
    CHECK_NEAR(row_orthonormality(&svd.vt), 0.0, 1e-12);
    for (size_t i = 1; i < svd.count; i++) CHECK(svd.sigma[i] <= svd.sigma[i - 1]);
    for (size_t i = 0; i < svd.count; i++) {
        double largest = 0.0;
        for (size_t r = 0; r < a->rows; r++) {
            const double value = svd.u.at[r * svd.u.stride + i];
            if (fabs(value) > fabs(largest)) largest = value;
        }
        CHECK(largest > 0.0);
    }
    linalg_svd_finish(test_host(), &svd);
}

TEST(linalg_svd_reconstructs_tall_wide_and_tiny_matrices)
{
    static const size_t sizes[][2] = { { 1, 1 },  { 1, 9 },   { 9, 1 },   { 17, 5 },
                                       { 5, 17 }, { 40, 40 }, { 200, 30 } };
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        struct matrix_f64 a = random_matrix(sizes[i][0], sizes[i][1], (uint32_t)i);
        check_svd_laws(&a);
        matrix_f64_finish(test_host(), &a);
    }
}

TEST(linalg_svd_of_a_block_reads_only_the_block)
{
    struct matrix_f64 a = random_matrix(20, 20, 7);
    a.at[0] = (double)NAN;
    const struct matrix_f64 block = matrix_f64_block(&a, 3, 5, 8, 6);
    check_svd_laws(&block);
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_svd_of_a_matrix_of_rank_two_has_two_values)
{
    struct matrix_f64 u = random_matrix(12, 2, 1), v = random_matrix(2, 9, 2), a;
    struct linalg_svd svd;
    CHECK(matrix_f64_init(test_host(), &a, 12, 9));
    CHECK(matrix_f64_multiply(test_host(), 1.0, &u, NOT_TRANSPOSED, &v, NOT_TRANSPOSED, 0.0, &a));
    CHECK(linalg_svd(test_host(), "a", &a, &svd));
    CHECK(svd.sigma[1] > 0.1 && svd.sigma[2] < 1e-14);
    CHECK_NEAR(matrix_f64_orthonormality(test_host(), &svd.u), 0.0, 1e-12);
    linalg_svd_finish(test_host(), &svd);
    matrix_f64_finish(test_host(), &a);
    matrix_f64_finish(test_host(), &u);
    matrix_f64_finish(test_host(), &v);
}

TEST(linalg_svd_of_nothing_is_nothing)
{
    struct matrix_f64 a = random_matrix(0, 4, 1);
    struct linalg_svd svd;
    CHECK(linalg_svd(test_host(), "a", &a, &svd));
    CHECK(svd.count == 0 && svd.vt.columns == 4);
    linalg_svd_finish(test_host(), &svd);
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_svd_refuses_what_is_not_finite_and_says_where)
{
    struct matrix_f64 a = random_matrix(4, 3, 1);
    struct linalg_svd svd;
    a.at[2 * 3 + 1] = (double)NAN;
    CHECK(!linalg_svd(test_host(), "cube/1/F", &a, &svd));
    CHECK_STRING(test_last_message(), "cannot decompose cube/1/F: element (2, 1) is not finite");
    a.at[2 * 3 + 1] = (double)INFINITY;
    CHECK(!linalg_svd(test_host(), "cube/1/F", &a, &svd) && svd.u.at == NULL);
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_svd_of_a_negated_matrix_keeps_the_left_vectors)
{
    struct matrix_f64 a = random_matrix(15, 6, 5), b = random_matrix(15, 6, 5);
    struct linalg_svd of_a, of_b;
    for (size_t i = 0; i < 15 * 6; i++) b.at[i] = -b.at[i];
    CHECK(linalg_svd(test_host(), "a", &a, &of_a) && linalg_svd(test_host(), "b", &b, &of_b));
    for (size_t i = 0; i < 15 * 6; i++) CHECK_NEAR(of_a.u.at[i], of_b.u.at[i], 1e-12);
    for (size_t i = 0; i < 6 * 6; i++) CHECK_NEAR(of_a.vt.at[i], -of_b.vt.at[i], 1e-12);
    linalg_svd_finish(test_host(), &of_a);
    linalg_svd_finish(test_host(), &of_b);
    matrix_f64_finish(test_host(), &a);
    matrix_f64_finish(test_host(), &b);
}

enum { RUNS = 16 };
static struct run {
    struct linalg_svd svd;
    bool ok;
} runs[RUNS];

// Each run's matrix lies at another offset from an aligned address.
static void decompose(void *user, size_t i)
{
    struct host host = host_default();
    struct matrix_f64 wide = { 0 };
    struct run *run = &((struct run *)user)[i];
    if (!matrix_f64_init(&host, &wide, 90, 70 + RUNS)) return;
    struct matrix_f64 a = matrix_f64_block(&wide, 0, i, 90, 70);
    struct rng rng = rng_for(11, 0, 0);
    for (size_t r = 0; r < 90; r++)
        for (size_t c = 0; c < 70; c++) a.at[r * a.stride + c] = (double)rng_float(&rng);
    run->ok = linalg_svd(&host, "a", &a, &run->svd);
    matrix_f64_finish(&host, &wide);
}

TEST(linalg_gives_the_same_bytes_on_any_number_of_threads_and_at_any_address)
{
    struct host host = host_default();
    struct run alone = { 0 };
    decompose(&alone, 0);
    parallel_for(RUNS, 1, decompose, runs);
    CHECK(alone.ok);
    for (size_t i = 0; i < RUNS; i++) {
        CHECK(runs[i].ok);
        CHECK(memcmp(alone.svd.u.at, runs[i].svd.u.at, 90 * 70 * sizeof(double)) == 0);
        CHECK(memcmp(alone.svd.vt.at, runs[i].svd.vt.at, 70 * 70 * sizeof(double)) == 0);
        CHECK(memcmp(alone.svd.sigma, runs[i].svd.sigma, 70 * sizeof(double)) == 0);
        linalg_svd_finish(&host, &runs[i].svd);
    }
    linalg_svd_finish(&host, &alone.svd);
}

TEST(linalg_symmetric_eigenvalues_by_hand)
{
    // [[2, 1], [1, 2]]: 3 with (1, 1)/√2 and 1 with (1, −1)/√2. The upper triangle is not read.
    const double values[] = { 2, 99, 1, 2 };
    struct matrix_f64 a = filled(2, 2, values);
    struct linalg_eigen eigen;
    CHECK(linalg_symmetric_eigen(test_host(), "a", &a, &eigen));
    CHECK_NEAR(eigen.values[0], 3.0, 1e-14);
    CHECK_NEAR(eigen.values[1], 1.0, 1e-14);
    const double h = sqrt(0.5), expected[] = { h, h, h, -h };
    for (size_t i = 0; i < 4; i++) CHECK_NEAR(eigen.vectors.at[i], expected[i], 1e-14);
    linalg_eigen_finish(test_host(), &eigen);
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_symmetric_eigen_refuses_other_shapes_and_values)
{
    struct matrix_f64 a = random_matrix(2, 3, 1);
    struct linalg_eigen eigen;
    CHECK(!linalg_symmetric_eigen(test_host(), "gram", &a, &eigen));
    CHECK_STRING(test_last_message(), "cannot decompose gram: 2 x 3 is not square");
    struct matrix_f64 square = matrix_f64_block(&a, 0, 0, 2, 2);
    square.at[0] = (double)NAN;
    CHECK(!linalg_symmetric_eigen(test_host(), "gram", &square, &eigen));
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_norms_and_conversions)
{
    const double values[] = { 3, 0, 0, 4 };
    struct matrix_f64 a = filled(2, 2, values), back;
    struct matrix_f32 rounded;
    CHECK_NEAR(matrix_f64_norm(&a), 5.0, 0.0);
    CHECK(matrix_f32_init(test_host(), &rounded, 2, 2));
    for (int i = 0; i < 4; i++) rounded.at[i] = (float)values[i];
    rounded.at[1] = 0.1f;
    CHECK(matrix_f64_from_f32(test_host(), &rounded, &back));
    CHECK(back.at[1] == (double)0.1f && back.at[3] == 4.0);
    CHECK_NEAR(matrix_f32_norm(&rounded), sqrt(25.01), 1e-8);
    matrix_f64_finish(test_host(), &a);
    matrix_f64_finish(test_host(), &back);
    matrix_f32_finish(test_host(), &rounded);
}

TEST(linalg_refuses_a_matrix_that_cannot_exist)
{
    struct matrix_f64 m;
    CHECK(!matrix_f64_init(test_host(), &m, (size_t)1 << 40, 2) && m.at == NULL);
    CHECK_STRING(test_last_message(), "cannot make a matrix of 1099511627776 x 2: too large");
}

// ---- truncation

// A matrix of rank 5, with noise of 1e-6 beyond.
static struct matrix_f64 nearly_of_rank_5(size_t rows, size_t columns)
{
    struct matrix_f64 a = random_matrix(rows, 5, 11), b = random_matrix(5, columns, 12);
    struct matrix_f64 out = random_matrix(rows, columns, 13);
    CHECK(
        matrix_f64_multiply(test_host(), 1.0, &a, NOT_TRANSPOSED, &b, NOT_TRANSPOSED, 1e-6, &out));
    matrix_f64_finish(test_host(), &a);
    matrix_f64_finish(test_host(), &b);
    return out;
}

// ‖a − u uᵀ a‖ / ‖a‖ of the vectors that are kept; count: how many.
static double truncation_error(const struct matrix_f64 *a, double energy, size_t rank,
                               size_t *count)
{
    struct matrix_f64 u, v, rest;
    CHECK(linalg_truncated_left(test_host(), "a test", a,
                                &(struct linalg_truncation){ energy, rank, 7 }, &u));
    CHECK(u.rows == a->rows && u.columns <= rank);
    CHECK(matrix_f64_orthonormality(test_host(), &u) < 1e-12);
    *count = u.columns;
    CHECK(matrix_f64_init(test_host(), &v, u.columns, a->columns));
    rest = filled(a->rows, a->columns, a->at);
    CHECK(
        matrix_f64_multiply(test_host(), 1.0, &u, TRANSPOSED, a, NOT_TRANSPOSED, 0.0, &v) &&
        matrix_f64_multiply(test_host(), -1.0, &u, NOT_TRANSPOSED, &v, NOT_TRANSPOSED, 1.0, &rest));
    const double error = matrix_f64_norm(&rest) / matrix_f64_norm(a);
    matrix_f64_finish(test_host(), &rest);
    matrix_f64_finish(test_host(), &v);
    matrix_f64_finish(test_host(), &u);
    return error;
}

// The error of the best approximation of a rank: √Σ σ² of the rest.
static double best_error(const struct matrix_f64 *a, size_t rank)
{
    struct linalg_svd svd;
    double sum = 0.0;
    CHECK(linalg_svd(test_host(), "a test", a, &svd));
    for (size_t i = rank; i < svd.count; i++) sum += svd.sigma[i] * svd.sigma[i];
    linalg_svd_finish(test_host(), &svd);
    return sqrt(sum) / matrix_f64_norm(a);
}

TEST(linalg_truncated_vectors_have_the_error_of_the_best_approximation_of_their_rank)
{
    struct matrix_f64 a = nearly_of_rank_5(60, 40);
    size_t count;
    for (size_t rank = 1; rank <= 6; rank++) {
        const double error = truncation_error(&a, 1.0, rank, &count), best = best_error(&a, rank);
        print_message("rank %zu: error %.3g, best %.3g\n", rank, error, best);
        CHECK(count == rank && error >= 0.999999 * best && error < 1.001 * best);
    }
    CHECK(truncation_error(&a, 1.0, 5, &count) < 1e-5);
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_truncated_vectors_are_as_few_as_the_energy_needs)
{
    struct matrix_f64 a = nearly_of_rank_5(60, 40);
    size_t all, few;
    CHECK(truncation_error(&a, 1.0 - 1e-9, 16, &all) < 1e-4 && all == 5);
    CHECK(truncation_error(&a, 0.5, 16, &few) < sqrt(0.5) && few >= 1 && few < all);
    matrix_f64_finish(test_host(), &a);
}

TEST(linalg_truncated_vectors_of_zeros_are_none)
{
    struct matrix_f64 a = { 0 }, u;
    CHECK(matrix_f64_init(test_host(), &a, 12, 9));
    CHECK(linalg_truncated_left(test_host(), "zeros", &a, &(struct linalg_truncation){ 0.99, 4, 1 },
                                &u));
    CHECK(u.rows == 12 && u.columns == 0);
    matrix_f64_finish(test_host(), &u);
    matrix_f64_finish(test_host(), &a);
}
