// Shapes, ray sets and lightfield samples of the block dictionary.
#include "framework/test.h"
#include "techniques/mrt/mrt_fixture.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/basis.h"
#include "techniques/mrt/dictionary/cube_shapes.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/interface.h"

#include <math.h>
#include <string.h>

enum { RESOLUTION = 6 };

TEST(every_block_of_a_maze_is_a_turned_cube_of_the_dictionary)
{
    unsigned walls = 1u << CUBE_LEFT | 1u << CUBE_RIGHT | 1u << CUBE_BACK | 1u << CUBE_FRONT;
    struct mrt_cube_place place;
    CHECK(mrt_dictionary_shapes(MRT_MAZE_2D) == 6 && mrt_dictionary_openings(MRT_MAZE_2D) == 12);
    CHECK(mrt_dictionary_shapes(MRT_MAZE_3D) == 9 && mrt_dictionary_openings(MRT_MAZE_3D) == 24);
    for (unsigned missing = 0; missing < CUBE_ALL_FACES; missing++) {
        CHECK(mrt_cube_find(MRT_MAZE_2D, missing, &place) == !(missing & ~walls));
        CHECK(mrt_cube_find(MRT_MAZE_3D, missing, &place));
        struct mrt_shape cube = mrt_cube(RESOLUTION, mrt_cube_missing(MRT_MAZE_3D, place.cube));
        struct mrt_shape block = mrt_cube(RESOLUTION, missing);
        CHECK_NEAR(glms_mat3_det(place.block_from_cube), 1.0, 1e-6);
        bool seen[CUBE_FACES * RESOLUTION * RESOLUTION] = { false };
        for (int t = 0; t < mrt_shape_texels(&block); t++) {
            int texel = mrt_rotated_texel(&cube, place.block_from_cube, &block, t);
            CHECK(texel >= 0 && texel < mrt_shape_texels(&cube) && !seen[texel]);
            seen[texel] = true;
        }
    }
}

TEST(a_ray_to_a_texel_centre_finds_that_texel)
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, 1u << CUBE_RIGHT);
    vec3s from = vec3_of(0.1f, -0.2f, 0.3f);
    struct mrt_hit hit;
    for (int t = 0; t < mrt_shape_texels(&cube); t++) {
        struct mrt_point at = mrt_shape_texel(&cube, t);
        mrt_shape_trace(&cube, from, glms_vec3_sub(at.position, from), &hit);
        CHECK(hit.texels == 4 && hit.opening < 0);
        float own = 0.0f;
        for (int k = 0; k < 4; k++) own += hit.texel[k] == t ? hit.weight[k] : 0.0f;
        CHECK_NEAR(own, 1.0, 1e-4);
        CHECK(glms_vec3_dot(at.frame.col[2], at.position) < 0.0f);
    }
    mrt_shape_trace(&cube, from, vec3_of(1, 0, 0), &hit);
    CHECK(hit.texels == 0 && hit.opening == CUBE_RIGHT);
}

TEST(operators_of_a_cube_with_openings_are_those_of_rays_inside_it)
{
    const struct mrt_cube_operators *closed = mrt_fixture_cube(RESOLUTION);
    struct mrt_shape shape = mrt_cube(RESOLUTION, 1u << CUBE_LEFT | 1u << CUBE_FRONT);
    size_t texels = (size_t)mrt_shape_texels(&shape);
    for (int m = MRT_IRRADIANCE; m <= MRT_VECTOR; m++) {
        const struct mrt_rays *rays = mrt_fixture_rays(RESOLUTION, (enum mrt_measure)m);
        size_t values = (size_t)rays->values;
        struct matrix_f64 part;
        float *rows = host_alloc(test_host(), values * texels, sizeof *rows);
        CHECK(mrt_cube_operator_of(test_host(), closed, (enum mrt_measure)m, &shape, &part));
        for (size_t t = 0; t < texels; t += 13) {
            memset(rows, 0, values * texels * sizeof *rows);
            mrt_gather(&shape, mrt_shape_texel(&shape, (int)t), rays, rows, texels);
            for (size_t i = 0; i < values * texels; i++)
                CHECK_NEAR(rows[i], part.at[t * values * part.stride + i], 1e-7);
        }
        host_free(test_host(), rows);
        matrix_f64_finish(test_host(), &part);
    }
}

// ---- irradiance as a function of the normal

// Least squares over the hemisphere, by quadrature: E(a) = ∫ (L2 − L1)² dω is smallest where its
// gradient ∫ (L2 − L1) Y_k dω is 0.
TEST(ohlsh_is_the_closest_linear_function_over_the_hemisphere)
{
    enum { POINTS = 1 << 16 };
    float sh[9], linear[4], y[9];
    struct rng rng = rng_for(3, 0, 0);
    for (int i = 0; i < 9; i++) sh[i] = 2.0f * rng_float(&rng) - 1.0f;
    mrt_ohlsh_from_sh9(sh, linear);
    double gradient[4] = { 0 };
    for (uint32_t p = 0; p < POINTS; p++) {
        sh_eval(3, sample_hemisphere_uniform(sobol_2d(p, 0)), y);
        double rest = 0.0;
        for (int i = 0; i < 9; i++)
            rest += (double)((sh[i] - (i < 4 ? linear[i] : 0.0f)) * y[i]) * 6.2831853 / POINTS;
        for (int k = 0; k < 4; k++) gradient[k] += rest * (double)y[k];
    }
    for (int k = 0; k < 4; k++) CHECK_NEAR(gradient[k], 0.0, 1e-4);
}

TEST(constant_radiosity_is_constant_irradiance_at_probes)
{
    const struct mrt_cube_operators *closed = mrt_fixture_cube(RESOLUTION);
    const struct matrix_f32 *probe = &closed->by_measure[MRT_PROBE];
    for (size_t r = 0; r < probe->rows; r++) {
        double sum = 0.0;
        for (size_t c = 0; c < probe->columns; c++) sum += (double)probe->at[r * probe->stride + c];
        CHECK_NEAR(sum, r % 9 == 0 ? sqrt(4.0 * 3.14159265) : 0.0, 2e-3);
    }
}

// Irradiance of the face's own plane, from four coefficients and from F.
TEST(vector_irradiance_along_the_normal_is_near_the_irradiance)
{
    const struct mrt_cube_operators *closed = mrt_fixture_cube(RESOLUTION);
    const struct matrix_f32 *f = &closed->by_measure[MRT_IRRADIANCE];
    const struct matrix_f32 *vector = &closed->by_measure[MRT_VECTOR];
    double worst = 0.0;
    for (int face = 0; face < CUBE_FACES; face++)
        for (size_t t = 0; t < f->rows; t++) {
            double scalar = 0.0, a[4] = { 0 };
            for (size_t c = 0; c < 36; c++) {
                size_t column = (size_t)face * 36 + c;
                scalar += (double)f->at[t * f->stride + column];
                for (size_t k = 0; k < 4; k++)
                    a[k] += (double)vector->at[(4 * t + k) * vector->stride + column];
            }
            float y[4];
            sh_eval(2, vec3_of(0, 0, 1), y);
            double value = 0.0;
            for (int k = 0; k < 4; k++) value += a[k] * (double)y[k];
            worst = fmax(worst, fabs(value - scalar));
        }
    print_message("one face lit: vector irradiance differs by at most %.3f of the radiosity\n",
                  worst);
    CHECK(worst < 0.1);
}

// ---- lightfields

static const struct mrt_lightfield LIGHTFIELD = { 4, 6, 3, false };

TEST(lightfield_lookup_at_a_sample_is_that_sample)
{
    struct mrt_lightfield centres = { 4, 6, 1, false };
    struct mrt_lightfield_lookup look;
    for (size_t s = 0; s < mrt_lightfield_samples(centres); s++) {
        vec3s at = mrt_lightfield_position(centres, s);
        mrt_lightfield_look_up(centres, at.x, at.y, mrt_lightfield_direction(centres, s, 0), &look);
        double own = 0.0;
        for (int k = 0; k < LIGHTFIELD_LOOKUP; k++)
            if (look.sample[k] == s) own += (double)look.weight[k];
        CHECK_NEAR(own, 1.0, 1e-4);
    }
}

static struct matrix_f32 propagate(enum mrt_turn turn, const struct matrix_f32 *from)
{
    struct matrix_f32 to;
    CHECK(matrix_f32_init(test_host(), &to, from->rows, from->columns));
    CHECK(mrt_propagate(test_host(), LIGHTFIELD, turn, from, 0, &to));
    return to;
}

TEST(four_rolls_are_the_identity)
{
    struct matrix_f32 from, to;
    struct rng rng = rng_for(5, 0, 0);
    CHECK(matrix_f32_init(test_host(), &from, mrt_lightfield_samples(LIGHTFIELD), 1));
    for (size_t i = 0; i < from.rows; i++) from.at[i] = rng_float(&rng);
    to = propagate(MRT_ROLL, &from);
    for (int i = 1; i < 4; i++) {
        struct matrix_f32 next = propagate(MRT_ROLL, &to);
        matrix_f32_finish(test_host(), &to);
        to = next;
    }
    for (size_t i = 0; i < from.rows; i++) CHECK_NEAR(to.at[i], from.at[i], 1e-4);
    matrix_f32_finish(test_host(), &from);
    matrix_f32_finish(test_host(), &to);
}

// Uniform light through the interface: what leaves by each exit has the form factor between unit
// squares, 0.1998 for parallel and 0.2000 for perpendicular ones, and none is lost.
TEST(exits_receive_the_form_factor_of_their_squares)
{
    struct matrix_f32 from;
    double all = 0.0, samples = (double)mrt_lightfield_samples(LIGHTFIELD);
    CHECK(matrix_f32_init(test_host(), &from, mrt_lightfield_samples(LIGHTFIELD), 1));
    for (size_t i = 0; i < from.rows; i++) from.at[i] = 1.0f;
    for (int turn = MRT_STRAIGHT; turn <= MRT_TURN_DOWN; turn++) {
        struct matrix_f32 to = propagate((enum mrt_turn)turn, &from);
        double flux = 0.0;
        for (size_t i = 0; i < to.rows; i++) flux += (double)to.at[i] / samples;
        print_message("turn %d: form factor %.4f\n", turn, flux);
        CHECK_NEAR(flux, turn == MRT_STRAIGHT ? 0.19982 : 0.20004, 0.004);
        all += flux;
        matrix_f32_finish(test_host(), &to);
    }
    CHECK_NEAR(all, 1.0, 0.01);
    matrix_f32_finish(test_host(), &from);
}

// Singular values and vectors from the Gram matrix, against LAPACK's.
TEST(reduced_basis_is_that_of_the_singular_value_decomposition)
{
    enum { ROWS = 700, COLUMNS = 24, MODES = 16 };
    struct matrix_f32 span_of, coefficients, basis;
    struct matrix_f64 gram, wide;
    struct linalg_svd svd;
    double sigma[MODES], factor[COLUMNS];
    struct rng rng = rng_for(9, 0, 0);
    CHECK(matrix_f32_init(test_host(), &span_of, ROWS, COLUMNS));
    CHECK(matrix_f32_init(test_host(), &coefficients, COLUMNS, MODES));
    CHECK(matrix_f32_init(test_host(), &basis, ROWS, MODES));
    CHECK(matrix_f64_init(test_host(), &gram, COLUMNS, COLUMNS));
    for (size_t i = 0; i < ROWS * COLUMNS; i++)
        span_of.at[i] = (rng_float(&rng) - 0.3f) / (float)(1 + i % COLUMNS);
    for (int c = 0; c < COLUMNS; c++) factor[c] = 1.0;
    struct mrt_span span = { { span_of }, 1 };
    CHECK(mrt_span_gram(test_host(), &span, 0, ROWS, &gram));
    CHECK(mrt_span_reduce(test_host(), &gram, factor, &coefficients, sigma));
    CHECK(mrt_span_apply(test_host(), &span, 0, &coefficients, &basis));
    CHECK(matrix_f64_from_f32(test_host(), &span_of, &wide));
    CHECK(linalg_svd(test_host(), "span", &wide, &svd));
    for (size_t m = 0; m < MODES; m++) {
        double along = 0.0;
        CHECK_RELATIVE(sigma[m], svd.sigma[m], 1e-6);
        for (size_t r = 0; r < ROWS; r++)
            along += (double)basis.at[r * MODES + m] * svd.u.at[r * svd.u.stride + m];
        CHECK_RELATIVE(fabs(along), sigma[m], 1e-4);
    }
    linalg_svd_finish(test_host(), &svd);
    matrix_f64_finish(test_host(), &wide);
    matrix_f64_finish(test_host(), &gram);
    matrix_f32_finish(test_host(), &basis);
    matrix_f32_finish(test_host(), &coefficients);
    matrix_f32_finish(test_host(), &span_of);
}

TEST(passages_of_a_plane_need_no_roll)
{
    static const int sides[4] = { CUBE_FRONT, CUBE_RIGHT, CUBE_BACK, CUBE_LEFT };
    for (int i = 0; i < 4; i++) {
        struct mrt_passage ahead = mrt_passage_between(sides[i], sides[(i + 2) % 4]);
        struct mrt_passage left = mrt_passage_between(sides[i], sides[(i + 3) % 4]);
        struct mrt_passage right = mrt_passage_between(sides[i], sides[(i + 1) % 4]);
        CHECK(ahead.turn == MRT_STRAIGHT && ahead.rolls == 0);
        CHECK(left.turn == MRT_TURN_LEFT && left.rolls == 0);
        CHECK(right.turn == MRT_TURN_RIGHT && right.rolls == 0);
    }
}
