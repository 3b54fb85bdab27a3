#include "framework/test.h"

#include "core/rng.h"
#include "core/sh.h"
#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_math.h"
#include "techniques/lpv/lpv_twin.h"

#include <complex.h>
#include <math.h>
#include <string.h>

enum { SCHEMES = 2, LOBES = 2 };

static const int NEIGHBOURS[SCHEMES] = { 6, 26 }, FACES[SCHEMES] = { 30, 54 };

TEST(lpv_faces_of_all_neighbours_cover_the_sphere_once)
{
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
        double sum = 0.0;
        int faces = 0;
        assert_int_equal(lpv_neighbours((enum lpv_scheme)scheme, neighbours), NEIGHBOURS[scheme]);
        for (int n = 0; n < NEIGHBOURS[scheme]; n++)
            for (int f = 0; f < neighbours[n].face_count; f++, faces++)
                sum += neighbours[n].faces[f].solid_angle_sr;
        assert_int_equal(faces, FACES[scheme]);
        CHECK_NEAR(sum, 4.0 * GLM_PI, 1e-12);
    }
}

// ∫ cosθ/r² over the face of the cell at `offset` with this normal.
static double integrated_sr(const int offset[3], vec3s normal)
{
    enum { N = 300 };
    double sum = 0.0;
    for (int i = 0; i < N * N; i++) {
        const double uv[2] = { (i % N + 0.5) / N - 0.5, (i / N + 0.5) / N - 0.5 };
        double p[3], r2 = 0.0, along = 0.0;
        for (int axis = 0, across = 0; axis < 3; axis++) {
            const double n = (double)normal.raw[axis];
            p[axis] = offset[axis] + (n == 0.0 ? uv[across++] : 0.5 * n);
            r2 += p[axis] * p[axis];
            along += p[axis] * n;
        }
        sum += along / (r2 * sqrt(r2));
    }
    return sum / (N * N);
}

TEST(lpv_face_solid_angles_equal_numerical_integration)
{
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
        const int count = lpv_neighbours((enum lpv_scheme)scheme, neighbours);
        for (int n = 0; n < count; n++)
            for (int f = 0; f < neighbours[n].face_count; f++) {
                const struct lpv_face *face = &neighbours[n].faces[f];
                CHECK_RELATIVE(face->solid_angle_sr,
                               integrated_sr(neighbours[n].offset, face->normal), 2e-5);
            }
    }
}

TEST(lpv_solid_angle_holds_down_to_distance_zero)
{
    CHECK_NEAR(lpv_rectangle_sr(-1, 1, -1, 1, 1e-9), 2.0 * GLM_PI, 1e-6);
    CHECK_NEAR(lpv_rectangle_sr(-1, 1, -1, 1, 1.0), 4.0 * GLM_PI / 6.0, 1e-12);
}

TEST(lpv_faces_point_away_from_the_source)
{
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
        const int count = lpv_neighbours((enum lpv_scheme)scheme, neighbours);
        for (int n = 0; n < count; n++)
            for (int f = 0; f < neighbours[n].face_count; f++) {
                const struct lpv_face *face = &neighbours[n].faces[f];
                const int *o = neighbours[n].offset;
                const vec3s to = vec3_of((float)o[0], (float)o[1], (float)o[2]);
                CHECK(glms_vec3_dot(face->direction, face->normal) > 0.0f);
                CHECK(glms_vec3_dot(face->direction, glms_vec3_normalize(to)) > 0.5f);
                CHECK_NEAR((double)glms_vec3_norm(face->direction), 1.0, 1e-6);
            }
    }
}

TEST(lpv_mean_path_of_a_step_is_the_mean_over_directions)
{
    enum { N = 200 };
    double sum = 0.0, most = 0.0, all = 0.0;
    for (int i = 0; i < N * N; i++) { // over the octant where all are positive
        const double z = (i % N + 0.5) / N, phi = (i / N + 0.5) / N * GLM_PI_2;
        const double x = sqrt(1.0 - z * z) * cos(phi), y = sqrt(1.0 - z * z) * sin(phi);
        sum += x + y + z, most += fmax(x, fmax(y, z)), all += 1.0;
    }
    CHECK_NEAR(lpv_mean_path(LPV_SIX), all / sum, 1e-4);
    CHECK_NEAR(lpv_mean_path(LPV_TWENTY_SIX), all / most, 1e-4);
}

// Coefficients of a face's lobe of unit flux, before the division by the quadrature of band 2.
TEST(lpv_lobe_at_two_thirds_is_the_clamped_cosine)
{
    float zonal[3];
    zh_clamped_cosine(3, zonal);
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
        const struct lpv_lobe_weights weights =
            lpv_lobe_weights_of((enum lpv_scheme)scheme, LPV_LOBE_PROPAGATION, 2.0 / 3.0, 0.0);
        for (int i = 0; i < 9; i++) {
            const int band = i == 0 ? 0 : i < 4 ? 1 : 2;
            const double cosine =
                sqrt(4.0 * GLM_PI / (2 * band + 1)) * (double)zonal[band] / GLM_PI;
            if (band < 2) CHECK_NEAR(lpv_lobe_weight(&weights, i), cosine, 1e-6);
        }
        // Mean weight of band 2: x² − y² and 3z² − 1 are two, xy, yz and xz three of five.
        const double mean = 5.0 / (2.0 / weights.square + 3.0 / weights.product);
        CHECK_NEAR(mean, sqrt(4.0 * GLM_PI / 5.0) * (double)zonal[2] / GLM_PI, 1e-6);
    }
}

// Sum of the coefficients that all neighbours receive from `in`.
static void received(enum lpv_scheme scheme, enum lpv_lobe lobe, double focus, const double in[9],
                     double out[9])
{
    struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
    const int count = lpv_neighbours(scheme, neighbours);
    const struct lpv_lobe_weights weights = lpv_lobe_weights_of(scheme, lobe, focus, 0.0);
    memset(out, 0, 9 * sizeof *out);
    for (int n = 0; n < count; n++)
        for (int f = 0; f < neighbours[n].face_count; f++) {
            const struct lpv_face *face = &neighbours[n].faces[f];
            float seen[9], sent[9];
            double flux = 0.0;
            sh_eval(3, face->direction, seen);
            sh_eval(3, lobe == LPV_LOBE_NORMAL ? face->normal : face->direction, sent);
            for (int i = 0; i < 9; i++) flux += face->solid_angle_sr * in[i] * (double)seen[i];
            for (int i = 0; i < 9; i++)
                out[i] += flux * lpv_lobe_weight(&weights, i) * (double)sent[i];
        }
}

static const double SOME_LIGHT[9] = { 1.0, 0.3, -0.7, 0.2, 0.4, -0.1, 0.25, 0.6, -0.5 };

TEST(lpv_step_conserves_flux_for_every_lobe)
{
    double out[9];
    for (int scheme = 0; scheme < SCHEMES; scheme++)
        for (int lobe = 0; lobe < LOBES; lobe++)
            for (int i = 0; i <= 4; i++) {
                received((enum lpv_scheme)scheme, (enum lpv_lobe)lobe, 0.25 * i, SOME_LIGHT, out);
                CHECK_NEAR(out[0], SOME_LIGHT[0], 1e-6);
            }
}

// Light of any direction keeps the same factors: `focus` in band 1, that of (cosθ)₊ⁿ in band 2.
TEST(lpv_step_scales_bands_by_focus)
{
    double out[9];
    for (int scheme = 0; scheme < SCHEMES; scheme++)
        for (int i = 0; i <= 4; i++) {
            const double focus = 0.25 * i, band_2 = fmax(2.0 * focus - 1.0, 0.0) / (2.0 - focus);
            received((enum lpv_scheme)scheme, LPV_LOBE_PROPAGATION, focus, SOME_LIGHT, out);
            for (int k = 1; k < 9; k++)
                CHECK_NEAR(out[k], (k < 4 ? focus : band_2) * SOME_LIGHT[k], 1e-6);
        }
}

TEST(lpv_lobes_of_higher_powers_of_the_cosine_have_their_band_2)
{
    for (int n = 1; n < 40; n += 3) {
        enum { N = 20000 };
        double flux = 0.0, mean = 0.0, legendre = 0.0;
        for (int i = 0; i < N; i++) {
            const double c = (i + 0.5) / N, weight = pow(c, n);
            flux += weight;
            mean += weight * c;
            legendre += weight * (1.5 * c * c - 0.5);
        }
        const struct lpv_lobe_weights weights =
            lpv_lobe_weights_of(LPV_TWENTY_SIX, LPV_LOBE_PROPAGATION, mean / flux, 0.0);
        const double band_2 = 5.0 / (2.0 / weights.square + 3.0 / weights.product);
        CHECK_NEAR(band_2, legendre / flux, 1e-4);
    }
}

// Growth per step of the wave exp(i k·x), by the power method.
static const double complex J = (double complex)I;

struct wave_step { // sum over the neighbours of matrix × phase of the wave
    double complex matrix[9][9];
};

static void wave_step_of(enum lpv_scheme scheme, enum lpv_lobe lobe, double focus,
                         const double k[3], struct wave_step *out)
{
    struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
    const int count = lpv_neighbours(scheme, neighbours);
    const struct lpv_lobe_weights weights = lpv_lobe_weights_of(scheme, lobe, focus, 0.0);
    memset(out, 0, sizeof *out);
    for (int n = 0; n < count; n++) {
        double phase = 0.0;
        for (int axis = 0; axis < 3; axis++) phase -= k[axis] * neighbours[n].offset[axis];
        for (int f = 0; f < neighbours[n].face_count; f++) {
            const struct lpv_face *face = &neighbours[n].faces[f];
            float seen[9], sent[9];
            sh_eval(3, face->direction, seen);
            sh_eval(3, lobe == LPV_LOBE_NORMAL ? face->normal : face->direction, sent);
            for (int i = 0; i < 81; i++)
                out->matrix[i / 9][i % 9] += cexp(J * phase) * face->solid_angle_sr *
                                             lpv_lobe_weight(&weights, i / 9) *
                                             (double)(sent[i / 9] * seen[i % 9]);
        }
    }
}

static double growth(const struct wave_step *step, int coefficients)
{
    enum { STEPS = 200 };
    double complex v[9] = { 1, 0.3 + 0.2 * J, -0.4, 0.7 * J, 0.5, -0.3 * J, 0.2, 0.1 + J, -0.6 };
    double grown = 0.0;
    for (int n = 0; n < STEPS; n++) {
        double complex next[9] = { 0 };
        double norm = 0.0;
        for (int i = 0; i < coefficients; i++) {
            for (int j = 0; j < coefficients; j++) next[i] += step->matrix[i][j] * v[j];
            norm += creal(next[i] * conj(next[i]));
        }
        norm = sqrt(norm);
        if (norm < 1e-200) return 0.0;
        if (n >= STEPS / 2) grown += log(norm);
        for (int i = 0; i < coefficients; i++) v[i] = next[i] / norm;
    }
    return exp(grown / (STEPS - STEPS / 2));
}

TEST(lpv_step_lets_no_wave_grow)
{
    enum { N = 4, FOCI = 5 };
    for (int which = 0; which < SCHEMES * LOBES * (FOCI + 1); which++) {
        const enum lpv_scheme scheme = (enum lpv_scheme)(which % 2);
        const enum lpv_lobe lobe = (enum lpv_lobe)(which / 2 % 2);
        const double focus = (double)(which / 4) / FOCI;
        for (int i = 0; i < (N + 1) * (N + 1) * (N + 1); i++) {
            const double k[3] = { GLM_PI * (i % (N + 1)) / N, GLM_PI * (i / (N + 1) % (N + 1)) / N,
                                  GLM_PI * (i / (N + 1) / (N + 1)) / N };
            struct wave_step step;
            wave_step_of(scheme, lobe, focus, k, &step);
            // The mean of 100 steps of the power method still depends on the initial vector.
            CHECK(growth(&step, 4) < 1.0 + 5e-3);
            CHECK(growth(&step, 9) < 1.0 + 5e-3);
        }
    }
}

TEST(lpv_grid_contains_the_bounds_with_at_most_dim_cells)
{
    struct rng rng = rng_for(2, 0, 0);
    for (int i = 0; i < 2000; i++) {
        const float scale = powf(10.0f, 8.0f * rng_float(&rng) - 4.0f);
        const int dim = 8 * (1 + i % 8);
        const float margin = 0.5f * (float)(i % 5);
        struct box3 box = { .min = vec3_of(rng_float(&rng), rng_float(&rng), rng_float(&rng)) };
        box.min = glms_vec3_scale(box.min, 10.0f * scale * (rng_float(&rng) - 0.5f));
        const vec3s size =
            vec3_of(rng_float(&rng), i % 3 ? rng_float(&rng) : 0.0f, rng_float(&rng));
        box.max = glms_vec3_add(box.min, glms_vec3_scale(size, scale));
        struct lpv_grid grid;
        CHECK(lpv_grid_fit(box, dim, margin, &grid));
        for (int axis = 0; axis < 3; axis++) {
            const float low = grid.origin_m.raw[axis],
                        tiny = 1e-4f * grid.cell_m + 1e-6f * fabsf(low);
            CHECK(grid.cells[axis] >= 1 && grid.cells[axis] <= dim);
            CHECK(low <= box.min.raw[axis] - margin * grid.cell_m + tiny);
            CHECK(low + (float)grid.cells[axis] * grid.cell_m >=
                  box.max.raw[axis] + margin * grid.cell_m - tiny);
        }
    }
}

TEST(lpv_grid_moves_by_whole_cells_when_the_bounds_change_a_little)
{
    struct box3 box = { vec3_of(-3.3f, 0.1f, -2.2f), vec3_of(4.1f, 3.0f, 2.7f) };
    struct lpv_grid grid, moved;
    CHECK(lpv_grid_fit(box, 32, 0.0f, &grid));
    box.max.y += 0.01f;
    box.min.z -= 0.01f;
    CHECK(lpv_grid_fit(box, 32, 0.0f, &moved));
    CHECK(moved.cell_m == grid.cell_m);
    for (int axis = 0; axis < 3; axis++) {
        const float cells = (moved.origin_m.raw[axis] - grid.origin_m.raw[axis]) / grid.cell_m;
        CHECK_NEAR((double)cells, (double)roundf(cells), 1e-4);
    }
}

TEST(lpv_grid_refuses_bounds_without_extent)
{
    struct lpv_grid grid;
    CHECK(!lpv_grid_fit(box3_empty(), 32, 0.0f, &grid));
    CHECK(!lpv_grid_fit((struct box3){ vec3_of(1, 1, 1), vec3_of(1, 1, 1) }, 32, 0.0f, &grid));
    CHECK(
        !lpv_grid_fit((struct box3){ vec3_of(0, 0, 0), vec3_of(INFINITY, 1, 1) }, 32, 0.0f, &grid));
}

static bool scale_of(const struct rsm_face *faces, int count, struct lpv_scale *out)
{
    return lpv_scale_of(
        &(struct lpv_lights){ .faces = faces, .face_count = count, .rsm_size = 256 }, out);
}

TEST(lpv_scales_include_emissive_surfaces)
{
    struct rsm_face face = { .type = FRAME_LIGHT_SUN, .intensity = { { 1e-3f, 0, 0 } } };
    struct frame_emitter points[3] = { { .flux = { { 1, 2, 3 } } },
                                       { .flux = { { 900, 10, 0 } } },
                                       { .flux = { { 0, 700, 1 } } } };
    struct lpv_scale rsm, all, alone;
    struct lpv_lights lights = {
        .faces = &face, .face_count = 1, .rsm_size = 256, .emitters = points, .emitter_count = 3
    };
    CHECK(lpv_scale_of(&lights, &all));
    CHECK(900 * 0.33f * all.fixed_from_flux <= 1073741824.0f);
    CHECK((65.5f + 1603) * all.grid_from_flux <= 8192 &&
          (65.5f + 1603) * all.grid_from_flux > 4095);
    CHECK(scale_of(&face, 1, &rsm) && rsm.fixed_from_flux > all.fixed_from_flux);
    lights.face_count = 0;
    CHECK(lpv_scale_of(&lights, &alone) && alone.fixed_from_flux == all.fixed_from_flux);
}

TEST(lpv_scales_are_powers_of_two_that_follow_the_light)
{
    struct rsm_face faces[2] = {
        { .type = FRAME_LIGHT_SUN, .intensity = { { 3.7f, 1.0f, 0.1f } } },
        { .type = FRAME_LIGHT_POINT, .intensity = { { 0.0f, 812.0f, 3.0f } }, .tan_half = 1.0f },
    };
    struct lpv_scale one, two;
    CHECK(scale_of(faces, 2, &one));
    for (int i = 0; i < 2; i++) faces[i].intensity = glms_vec3_scale(faces[i].intensity, 2.0f);
    CHECK(scale_of(faces, 2, &two));
    CHECK(one.fixed_from_flux == 2.0f * two.fixed_from_flux);
    CHECK(one.grid_from_flux == 2.0f * two.grid_from_flux);
    int exponent;
    CHECK(frexpf(one.fixed_from_flux, &exponent) == 0.5f);
    CHECK(frexpf(one.grid_from_flux, &exponent) == 0.5f);
    // A block of texels that equal the strongest one, here of a sun.
    CHECK(7.4f * LPV_TEXELS * LPV_TEXELS * 0.33f * two.fixed_from_flux <= 1073741824.0f);
    for (int i = 0; i < 2; i++) faces[i].intensity = vec3_of(0, 0, 0);
    CHECK(!scale_of(faces, 2, &one));
    CHECK(!scale_of(faces, 0, &one));
}
