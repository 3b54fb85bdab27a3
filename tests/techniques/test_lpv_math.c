#include "framework/test.h"

#include "core/rng.h"
#include "core/sh.h"
#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_math.h"

#include <complex.h>
#include <math.h>
#include <string.h>

TEST(lpv_thirty_faces_cover_the_sphere_once)
{
    double sum = 0.0;
    for (int direction = 0; direction < LPV_DIRECTIONS; direction++) {
        struct lpv_face faces[LPV_FACES];
        lpv_faces(direction, faces);
        for (int f = 0; f < LPV_FACES; f++) sum += faces[f].solid_angle_sr;
    }
    CHECK_NEAR(sum, 4.0 * GLM_PI, 1e-12);
}

TEST(lpv_face_solid_angles_are_what_integration_gives)
{
    struct lpv_face faces[LPV_FACES];
    lpv_faces(0, faces);
    enum { N = 400 };
    double front = 0.0, side = 0.0;
    for (int i = 0; i < N * N; i++) {
        const double u = (i % N + 0.5) / N - 0.5, v = (i / N + 0.5) / N - 0.5;
        front += 1.5 / pow(1.5 * 1.5 + u * u + v * v, 1.5); // the plane x = 1.5
        side += 0.5 / pow(0.5 * 0.5 + (u + 1) * (u + 1) + v * v,
                          1.5); // the plane y = 0.5, x from 0.5 to 1.5
    }
    CHECK_RELATIVE(faces[0].solid_angle_sr, front / (N * N), 1e-6);
    for (int f = 1; f < LPV_FACES; f++)
        CHECK_RELATIVE(faces[f].solid_angle_sr, side / (N * N), 1e-5);
}

TEST(lpv_solid_angle_holds_down_to_distance_zero)
{
    CHECK_NEAR(lpv_rectangle_sr(-1, 1, -1, 1, 1e-9), 2.0 * GLM_PI, 1e-6);
    CHECK_NEAR(lpv_rectangle_sr(-1, 1, -1, 1, 1.0), 4.0 * GLM_PI / 6.0, 1e-12);
}

TEST(lpv_faces_look_away_from_the_source)
{
    for (int direction = 0; direction < LPV_DIRECTIONS; direction++) {
        struct lpv_face faces[LPV_FACES];
        lpv_faces(direction, faces);
        for (int f = 0; f < LPV_FACES; f++) {
            CHECK(glms_vec3_dot(faces[f].direction, faces[f].normal) > 0.0f);
            CHECK(glms_vec3_dot(faces[f].direction, lpv_direction(direction)) > 0.5f);
            CHECK_NEAR((double)glms_vec3_norm(faces[f].direction), 1.0, 1e-6);
        }
    }
}

TEST(lpv_lobe_at_two_thirds_is_the_clamped_cosine)
{
    struct rng rng = rng_for(1, 0, 0);
    float zonal[2], expected[4], lobe[4];
    zh_clamped_cosine(2, zonal);
    for (int i = 0; i < 50; i++) {
        const vec3s axis = glms_vec3_normalize(
            vec3_of(rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f));
        zh_rotate(2, zonal, axis, expected);
        lpv_lobe_coefficients(axis, 2.0f / 3.0f, lobe);
        for (int k = 0; k < 4; k++) CHECK_NEAR((double)lobe[k], (double)expected[k] / GLM_PI, 1e-6);
    }
}

// What all six neighbours receive together, from coefficients `in`.
static void received(enum lpv_lobe lobe, float mean_cosine, const double in[4], double out[4])
{
    memset(out, 0, 4 * sizeof *out);
    for (int direction = 0; direction < LPV_DIRECTIONS; direction++) {
        double m[4][4];
        lpv_step_matrix(direction, lobe, mean_cosine, m);
        for (int i = 0; i < 16; i++) out[i / 4] += m[i / 4][i % 4] * in[i % 4];
    }
}

TEST(lpv_step_conserves_flux_whatever_the_lobe)
{
    const double in[4] = { 1.0, 0.3, -0.7, 0.2 };
    double out[4];
    for (int lobe = 0; lobe < 2; lobe++)
        for (float focus = 0.0f; focus <= 1.0f; focus += 0.25f) {
            received((enum lpv_lobe)lobe, focus, in, out);
            CHECK_NEAR(out[0], in[0], 1e-6);
        }
}

TEST(lpv_step_keeps_of_the_direction_what_focus_says)
{
    const double in[4] = { 1.0, 0.3, -0.7, 0.2 };
    double out[4];
    for (float focus = 0.0f; focus <= 1.0f; focus += 0.25f) {
        received(LPV_LOBE_PROPAGATION, focus, in, out);
        for (int i = 1; i < 4; i++) CHECK_NEAR(out[i], (double)focus * in[i], 1e-6);
    }
}

TEST(lpv_five_numbers_are_the_sum_over_faces)
{
    static const int component[3] = { 3, 1, 2 }; // of x, y, z
    for (int lobe = 0; lobe < 2; lobe++)
        for (int direction = 0; direction < LPV_DIRECTIONS; direction++) {
            double m[4][4], expected[4][4] = { { 0 } };
            lpv_step_matrix(direction, (enum lpv_lobe)lobe, 0.8f, m);
            const struct lpv_step step = lpv_step_of((enum lpv_lobe)lobe, 0.8f);
            const int a = component[direction / 2];
            const double sign = direction % 2 == 0 ? 1.0 : -1.0;
            for (int i = 1; i < 4; i++)
                expected[i][i] = (double)(i == a ? step.along : step.across);
            expected[0][0] = (double)step.keep;
            expected[0][a] = sign * (double)step.drive;
            expected[a][0] = sign * (double)step.aim;
            for (int i = 0; i < 16; i++) CHECK_NEAR(m[i / 4][i % 4], expected[i / 4][i % 4], 1e-6);
        }
}

// Growth per step of the wave exp(i k·x), by the power method.
static const double complex J = (double complex)I;

static double growth(const struct lpv_step *step, const double k[3])
{
    enum { STEPS = 300 };
    static const int component[3] = { 3, 1, 2 };
    double complex v[4] = { 1, 0.3 + 0.2 * J, -0.4, 0.7 * J };
    double grown = 0.0;
    for (int n = 0; n < STEPS; n++) {
        double complex next[4] = { 0 };
        for (int axis = 0; axis < 3; axis++) {
            const double complex sum = 2.0 * cos(k[axis]), difference = -2.0 * J * sin(k[axis]);
            const int a = component[axis];
            next[0] += (double)step->keep * sum * v[0] + (double)step->drive * difference * v[a];
            for (int i = 1; i < 4; i++)
                next[i] += (double)(i == a ? step->along : step->across) * sum * v[i];
            next[a] += (double)step->aim * difference * v[0];
        }
        double norm = 0.0;
        for (int i = 0; i < 4; i++) norm += creal(next[i] * conj(next[i]));
        norm = sqrt(norm);
        if (norm < 1e-200) return 0.0;
        if (n >= STEPS / 2) grown += log(norm);
        for (int i = 0; i < 4; i++) v[i] = next[i] / norm;
    }
    return exp(grown / (STEPS - STEPS / 2));
}

TEST(lpv_step_lets_no_wave_grow)
{
    enum { N = 6 };
    for (int lobe = 0; lobe < 2; lobe++)
        for (float focus = 0.0f; focus <= 1.0f; focus += 0.2f) {
            const struct lpv_step step = lpv_step_of((enum lpv_lobe)lobe, focus);
            for (int i = 0; i < (N + 1) * (N + 1) * (N + 1); i++) {
                const double k[3] = { GLM_PI * (i % (N + 1)) / N,
                                      GLM_PI * (i / (N + 1) % (N + 1)) / N,
                                      GLM_PI * (i / (N + 1) / (N + 1)) / N };
                CHECK(growth(&step, k) < 1.0 + 1e-4);
            }
        }
}

TEST(lpv_grid_holds_the_bounds_and_never_more_than_its_cells)
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

TEST(lpv_grid_stands_still_while_the_bounds_breathe)
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

TEST(lpv_scales_bound_emissive_surfaces_with_the_rest)
{
    struct rsm_face face = { .type = FRAME_LIGHT_SUN, .intensity = { { 1e-3f, 0, 0 } } };
    struct frame_emitter points[3] = { { .flux = { { 1, 2, 3 } } },
                                       { .flux = { { 900, 10, 0 } } },
                                       { .flux = { { 0, 700, 1 } } } };
    struct lpv_scale rsm, all, alone;
    struct lpv_lights lights = { &face, 1, 256, points, 3 };
    CHECK(lpv_scale_of(&lights, &all));
    CHECK(900 * 0.33f * all.fixed_from_flux <= 1073741824.0f);
    CHECK((65.5f + 1603) * all.grid_from_flux <= 1024 && (65.5f + 1603) * all.grid_from_flux > 511);
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
    // The strongest texel, a sun's here, fills a block.
    CHECK(7.4f * LPV_TEXELS * LPV_TEXELS * 0.33f * two.fixed_from_flux <= 1073741824.0f);
    for (int i = 0; i < 2; i++) faces[i].intensity = vec3_of(0, 0, 0);
    CHECK(!scale_of(faces, 2, &one));
    CHECK(!scale_of(faces, 0, &one));
}
