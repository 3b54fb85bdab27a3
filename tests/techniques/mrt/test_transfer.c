// Reduced transfer of the closed cube of modular radiance transfer: spectra, operators, and errors
// for lights inside and outside the prior.
#include "framework/test.h"
#include "techniques/mrt/mrt_fixture.h"

#include "core/rng.h"

#include "techniques/mrt/dictionary/prior.h"

#include <math.h>
#include <stdlib.h>

enum { RESOLUTION = 16 };

static const double SHARES[3] = { 0.80, 0.90, 0.95 };

// out = a · x
static void apply(const struct matrix_f64 *a, const double *x, double *out)
{
    for (size_t r = 0; r < a->rows; r++) {
        out[r] = 0.0;
        for (size_t c = 0; c < a->columns; c++) out[r] += a->at[r * a->stride + c] * x[c];
    }
}

static void count_modes(const char *what, const double *sigma, size_t count, int modes[3])
{
    for (int i = 0; i < 3; i++) modes[i] = mrt_modes_for_energy(sigma, count, SHARES[i]);
    print_message("modes of %s for 80, 90, 95 %% of the energy: %d %d %d\n", what, modes[0],
                  modes[1], modes[2]);
}

// Table 3.2 of the paper.
TEST(spectra_of_the_closed_cube_are_those_of_the_paper)
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, 0);
    struct matrix_f64 f, gram;
    struct mrt_transfer transfer;
    struct linalg_eigen eigen;
    int modes[3];
    mrt_fixture_transfer(&cube, 32, false, &f, &transfer);
    CHECK(matrix_f64_init(test_host(), &gram, f.rows, f.rows));
    CHECK(matrix_f64_multiply(test_host(), 1.0, &f, TRANSPOSED, &f, NOT_TRANSPOSED, 0.0, &gram));
    CHECK(linalg_symmetric_eigen(test_host(), "F'F", &gram, &eigen));
    for (size_t i = 0; i < f.rows; i++) eigen.values[i] = sqrt(fmax(eigen.values[i], 0.0));
    count_modes("F (paper: 164 240 313)", eigen.values, f.rows, modes);
    CHECK_NEAR(modes[0], 164, 2);
    CHECK_NEAR(modes[1], 240, 2);
    CHECK_NEAR(modes[2], 313, 3);
    count_modes("the prior (paper: 22 41 62)", transfer.sigma_l, transfer.sigma_l_count, modes);
    count_modes("M (paper: 1 5 8)", transfer.sigma_m, transfer.sigma_m_count, modes);
    linalg_eigen_finish(test_host(), &eigen);
    matrix_f64_finish(test_host(), &gram);
    matrix_f64_finish(test_host(), &f);
    mrt_transfer_finish(test_host(), &transfer);
}

TEST(rows_of_the_one_bounce_operator_sum_to_one_in_the_closed_cube)
{
    const struct matrix_f32 *f = &mrt_fixture_cube(RESOLUTION)->by_measure[MRT_IRRADIANCE];
    double worst = 0.0;
    for (size_t r = 0; r < f->rows; r++) {
        double sum = 0.0;
        for (size_t c = 0; c < f->columns; c++) sum += (double)f->at[r * f->stride + c];
        worst = fmax(worst, fabs(sum - 1.0));
    }
    print_message("row sums of F differ from 1 by at most %.2e\n", worst);
    CHECK(worst < 1e-5);
}

TEST(operators_hold_their_identities)
{
    for (int enrich = 0; enrich < 2; enrich++) {
        struct mrt_shape cube = mrt_cube(RESOLUTION, 0);
        struct matrix_f64 f;
        struct mrt_transfer t;
        mrt_fixture_transfer(&cube, 32, enrich, &f, &t);
        print_message("enriched %d: |Um'Um - I| %.2e, |F Limp - Ub| / |Ub| %.2e\n", enrich,
                      t.orthonormality, t.implicit_error);
        CHECK(t.orthonormality < 1e-12);
        CHECK(t.implicit_error < 1e-12);
        matrix_f64_finish(test_host(), &f);
        mrt_transfer_finish(test_host(), &t);
    }
}

// ---- errors

struct reduced {
    struct matrix_f64 f;
    struct mrt_transfer transfer;
    double *light, *exact, *b, *indirect; // n, n, k_b, n
};

static void reduced_init(int k_b, bool enrich, struct reduced *r)
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, 0);
    mrt_fixture_transfer(&cube, k_b, enrich, &r->f, &r->transfer);
    r->light = host_alloc(test_host(), 4 * r->f.rows, sizeof *r->light);
    CHECK(r->light != NULL);
    r->exact = r->light + r->f.rows;
    r->b = r->exact + r->f.rows;
    r->indirect = r->b + r->f.rows;
}

static void reduced_finish(struct reduced *r)
{
    matrix_f64_finish(test_host(), &r->f);
    mrt_transfer_finish(test_host(), &r->transfer);
    host_free(test_host(), r->light);
}

// Relative L2 error of U_b T_d→b l against F l.
static double reduced_error(struct reduced *r)
{
    double difference = 0.0, all = 0.0;
    apply(&r->f, r->light, r->exact);
    apply(&r->transfer.t_db, r->light, r->b);
    apply(&r->transfer.u_b, r->b, r->indirect);
    for (size_t i = 0; i < r->f.rows; i++) {
        difference += (r->indirect[i] - r->exact[i]) * (r->indirect[i] - r->exact[i]);
        all += r->exact[i] * r->exact[i];
    }
    return sqrt(difference / all);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { LIGHTS = 200 };

static void point_light_errors(struct reduced *r, double errors[LIGHTS])
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, 0);
    for (uint32_t i = 0; i < LIGHTS; i++) {
        struct rng rng = rng_for(i, 0, 7);
        vec3s at;
        for (int a = 0; a < 3; a++) at.raw[a] = 0.8f * rng_float(&rng) - 0.4f;
        for (size_t t = 0; t < r->f.rows; t++)
            r->light[t] = (double)mrt_point_light(mrt_shape_texel(&cube, (int)t), at);
        errors[i] = reduced_error(r);
    }
    qsort(errors, LIGHTS, sizeof *errors, ascending);
}

// Bounds: what the method reaches here, plus a tenth.
static const struct {
    int k_b;
    bool enrich;
    double median, high, worst;
} POINT_LIGHTS[] = {
    { 12, false, 0.108, 0.319, 0.474 },
    { 12, true, 0.156, 0.367, 0.510 },
    { 32, false, 0.041, 0.123, 0.223 },
    { 32, true, 0.063, 0.142, 0.212 },
};

TEST(indirect_light_of_point_lights_is_near_that_of_the_full_operator)
{
    for (size_t i = 0; i < sizeof POINT_LIGHTS / sizeof *POINT_LIGHTS; i++) {
        struct reduced r;
        double errors[LIGHTS];
        reduced_init(POINT_LIGHTS[i].k_b, POINT_LIGHTS[i].enrich, &r);
        point_light_errors(&r, errors);
        double median = errors[LIGHTS / 2], high = errors[LIGHTS * 95 / 100];
        print_message("k_b %d, enriched %d: error of 200 lights: median %.4f, 95th %.4f, "
                      "worst %.4f\n",
                      POINT_LIGHTS[i].k_b, POINT_LIGHTS[i].enrich, median, high,
                      errors[LIGHTS - 1]);
        CHECK(median < POINT_LIGHTS[i].median);
        CHECK(high < POINT_LIGHTS[i].high);
        CHECK(errors[LIGHTS - 1] < POINT_LIGHTS[i].worst);
        reduced_finish(&r);
    }
}

static double face_mean(const double *x, int face)
{
    double sum = 0.0;
    int in_face = RESOLUTION * RESOLUTION;
    for (int i = 0; i < in_face; i++) sum += x[face * in_face + i];
    return sum / (double)in_face;
}

TEST(a_lit_face_lights_the_others_and_not_itself)
{
    for (int enrich = 0; enrich < 2; enrich++) {
        struct reduced r;
        reduced_init(32, enrich, &r);
        double worst = 0.0, self = 0.0;
        for (int face = 0; face < CUBE_FACES; face++) {
            for (int i = 0; i < (int)r.f.rows; i++)
                r.light[i] = i / (RESOLUTION * RESOLUTION) == face;
            worst = fmax(worst, reduced_error(&r));
            double others = 0.0;
            for (int f = 0; f < CUBE_FACES; f++)
                if (f != face) others += face_mean(r.indirect, f) / 5.0;
            self = fmax(self, fabs(face_mean(r.indirect, face)) / others);
        }
        print_message("enriched %d: one face lit: error %.4f, itself %.4f of the others\n", enrich,
                      worst, self);
        if (enrich) {
            CHECK(worst < 0.011);
            CHECK(self < 0.002);
        }
        reduced_finish(&r);
    }
}
