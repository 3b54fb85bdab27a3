// Each GPU stage: equality with the plain C twin, bitwise invariants.
#include "techniques/lpv/lpv_fixture.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 24, WIDTH = 16, HEIGHT = 8, PIXELS = WIDTH * HEIGHT };

static vec3s random_direction(struct rng *rng)
{
    return glms_vec3_normalize(
        vec3_of(rng_float(rng) - 0.5f, rng_float(rng) - 0.5f, rng_float(rng) - 0.5f));
}

// Two maps with texels scattered over a box of 4 × 3 × 3.5 m, some outside, some empty.
static void scatter(struct rsm_fixture *rsm, struct gpu *gpu)
{
    struct rng rng = rng_for(5, 0, 0);
    rsm_fixture_init(rsm, gpu, WIDTH, HEIGHT, SIZE, 2);
    rsm->view.bounds = (struct box3){ vec3_of(-2.1f, 0.3f, 1.2f), vec3_of(1.9f, 3.3f, 4.7f) };
    rsm_fixture_set_face(rsm, 0, vec3_of(-2.5f, 0.2f, 1.1f), vec3_of(4.6f, 0.3f, 0.1f),
                         vec3_of(0.2f, 3.2f, 0.3f), vec3_of(0.1f, -0.2f, 3.6f), vec3_of(3, 2, 1));
    rsm_fixture_set_face(rsm, 1, vec3_of(1.7f, 3.1f, 4.6f), vec3_of(-3.3f, 0.3f, 0.1f),
                         vec3_of(0.2f, 0.2f, -3.2f), vec3_of(0.1f, -2.6f, 0.2f),
                         vec3_of(0.01f, 40, 1));
    for (int face = 0; face < 2; face++)
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            struct rsm_fixture_texel texel = { .depth = i % 7 == 0 ? 0.0f : rng_float(&rng),
                                               .normal = random_direction(&rng) };
            for (int c = 0; c < 3; c++) texel.reflectance[c] = (uint8_t)(rng_u32(&rng) & 255);
            *rsm_fixture_texel(rsm, face, i % SIZE, i / SIZE) = texel;
        }
    rsm_fixture_show_wall(rsm, vec3_of(-2, 0.5f, 1.5f), vec3_of(3.5f, 0.2f, 0.1f),
                          vec3_of(0.1f, 0.3f, 3), vec3_of(0, 1, 0));
    rsm_fixture_upload(rsm);
}

static double largest(const struct twin *twin, double (*values)[9])
{
    double most = 0.0;
    for (size_t i = 0; i < twin_cells(twin); i++)
        for (int k = 0; k < SH_COUNT(twin->bands); k++) most = fmax(most, fabs(values[i][k]));
    return most;
}

// `tolerance` is relative to the largest coefficient.
static void check_volume(const float *got, const struct twin *twin, double (*expected)[9],
                         double tolerance)
{
    const size_t coefficients = (size_t)SH_COUNT(twin->bands);
    const double most = largest(twin, expected);
    CHECK(most > 0.0);
    for (size_t i = 0; i < twin_cells(twin); i++)
        for (size_t k = 0; k < coefficients; k++)
            CHECK_NEAR((double)got[coefficients * i + k], expected[i][k], tolerance * most);
}

// Half floats have 11 bits; floats are converted from integer sums.
static double rounding(const struct lpv *lpv)
{
    return lpv->options.precision == LPV_PRECISION_HALF ? 5e-4 : 1e-5;
}

static void twin_of(struct twin *twin, struct lpv *lpv, const struct rsm_fixture *rsm, int colour)
{
    twin_init_as(twin, lpv);
    lpv_fixture_inject_twin(twin, rsm, colour);
}

static void check_injection(struct lpv *lpv, struct rsm_fixture *rsm)
{
    lpv_fixture_render(lpv, rsm);
    for (int colour = 0; colour < LPV_FIXTURE_COLOURS; colour++) {
        struct twin twin;
        twin_of(&twin, lpv, rsm, colour);
        float *got = lpv_fixture_read(lpv, lpv->injection.injected, colour);
        check_volume(got, &twin, twin.light, rounding(lpv));
        free(got);
        twin_finish(&twin);
    }
}

static const char *const INJECTIONS[] = { "lpv:dim=8,steps=1", "lpv:dim=8,steps=1,precision=float",
                                          "holpv:dim=8,steps=1,precision=float" };
enum { INJECTION_COUNT = sizeof INJECTIONS / sizeof INJECTIONS[0] };

TEST_GPU(lpv_injection_equals_the_twin)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    for (int i = 0; i < INJECTION_COUNT; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, INJECTIONS[i]);
        check_injection(lpv, &rsm);
        lpv_fixture_destroy(lpv);
    }
    rsm_fixture_finish(&rsm);
}

enum { POINTS = 777 }; // not a multiple of a workgroup

// Points in and around the box, faint and strong ones.
static void scatter_points(struct frame_emitter *points)
{
    struct rng rng = rng_for(6, 0, 0);
    for (int i = 0; i < POINTS; i++) {
        const float strength = i % 5 == 0 ? 3.0f : 1e-3f;
        points[i] = (struct frame_emitter){
            .position = vec3_of(-2.2f + 4.2f * rng_float(&rng), 0.2f + 3.2f * rng_float(&rng),
                                1.1f + 3.7f * rng_float(&rng)),
            .normal = random_direction(&rng),
            .flux = vec3_of(strength * rng_float(&rng), strength, 0.5f * strength),
        };
    }
}

TEST_GPU(lpv_injection_of_emissive_surfaces_equals_the_twin)
{
    struct rsm_fixture rsm;
    struct frame_emitter points[POINTS];
    scatter(&rsm, gpu);
    scatter_points(points);
    rsm_fixture_set_emitters(&rsm, points, POINTS);
    for (int i = 0; i < INJECTION_COUNT; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, INJECTIONS[i]);
        rsm.view.rsm_face_count = 2;
        check_injection(lpv, &rsm); // with the maps
        rsm.view.rsm_face_count = 0;
        check_injection(lpv, &rsm); // alone
        lpv_fixture_destroy(lpv);
    }
    rsm_fixture_finish(&rsm);
}

static void propagation_equals_the_twin(struct gpu *gpu, const char *options)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, options);
    lpv_fixture_render(lpv, &rsm);
    for (int colour = 0; colour < LPV_FIXTURE_COLOURS; colour++) {
        struct twin twin;
        twin_of(&twin, lpv, &rsm, colour);
        twin_accumulate(&twin, &lpv->options);
        float *got = lpv_fixture_read(lpv, lpv->cascades[0].light, colour);
        check_volume(got, &twin, twin.accumulated, 1e-3);
        free(got);
        twin_finish(&twin);
    }
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_propagation_is_the_sum_over_faces_and_steps)
{
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=1,precision=float");
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=6");
    propagation_equals_the_twin(gpu, "lpv:dim=16,steps=20,focus=1,cell_margin=1.5,precision=float");
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=6,closure=linear");
    propagation_equals_the_twin(gpu,
                                "lpv:dim=8,steps=7,closure=linear,lobe=normal,focus=0.6666667");
    propagation_equals_the_twin(
        gpu, "lpv:dim=16,steps=20,closure=linear,focus=1,cell_margin=1.5,precision=float");
}

TEST_GPU(lpv_propagation_of_higher_order_is_the_sum_over_faces_and_steps)
{
    propagation_equals_the_twin(gpu, "holpv:dim=8,steps=1,precision=float");
    propagation_equals_the_twin(gpu, "holpv:dim=8,steps=6");
    propagation_equals_the_twin(gpu,
                                "holpv:dim=16,steps=20,focus=1,cell_margin=1.5,precision=float");
    propagation_equals_the_twin(gpu, "holpv:dim=8,steps=6,closure=linear,focus=0.99");
    propagation_equals_the_twin(gpu,
                                "holpv:dim=8,steps=7,closure=linear,lobe=normal,focus=0.6666667");
}

TEST_GPU(lpv_bands_and_neighbours_are_independent)
{
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=5,bands=3,focus=0.8");
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=5,bands=3,lobe=normal,precision=float");
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=5,neighbours=26,focus=0.8");
    propagation_equals_the_twin(gpu, "lpv:dim=8,steps=5,neighbours=26,lobe=normal,precision=float");
}

static void application_equals_the_twin(struct gpu *gpu, const char *options)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, options);
    lpv_fixture_render(lpv, &rsm);
    float got[PIXELS * 3];
    rsm_fixture_read_irradiance(&rsm, got);
    for (int colour = 0; colour < LPV_FIXTURE_COLOURS; colour++) {
        struct twin twin;
        twin_of(&twin, lpv, &rsm, colour);
        twin_accumulate(&twin, &lpv->options);
        double expected[PIXELS], most = 0.0;
        for (int i = 0; i < PIXELS; i++) {
            const float x = ((float)(i % WIDTH) + 0.5f) * 2.0f / WIDTH - 1.0f;
            const float y = ((float)(i / WIDTH) + 0.5f) * 2.0f / HEIGHT - 1.0f;
            expected[i] = twin_irradiance(
                &twin, mat4_point(rsm.constants.world_from_clip, vec3_of(x, y, 0.5f)),
                rsm_fixture_rounded_normal(vec3_of(0, 1, 0)), &lpv->options);
            most = fmax(most, expected[i]);
        }
        CHECK(most > 0.0);
        // Half floats, and filter weights that hardware may round to 8 bits.
        for (int i = 0; i < PIXELS; i++)
            CHECK_NEAR((double)got[3 * i + colour], expected[i], 5e-3 * most);
        twin_finish(&twin);
    }
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_application_equals_the_twin)
{
    application_equals_the_twin(gpu, "lpv:dim=8,steps=5,offset=0.75");
    application_equals_the_twin(gpu, "lpv:dim=8,steps=5,closure=linear,offset=0.75,window=0.8");
    application_equals_the_twin(gpu, "lpv:dim=8,steps=5,damping=0.8");
    application_equals_the_twin(gpu,
                                "lpv:dim=8,steps=5,closure=linear,damping=2,reconstruction=cubic");
    application_equals_the_twin(gpu, "holpv:dim=8,steps=5,offset=0.75");
    application_equals_the_twin(gpu, "holpv:dim=8,steps=5,closure=linear,offset=0.75,window=0.9");
    application_equals_the_twin(gpu, "holpv:dim=8,steps=5,damping=1,reconstruction=cubic");
}

// All values of the injected grid.
static float *injected(struct lpv *lpv, size_t *count)
{
    const size_t one =
        lpv_cell_count(&lpv->cascades[0].grid) * (size_t)SH_COUNT(lpv->options.bands);
    float *all = malloc(LPV_FIXTURE_COLOURS * one * sizeof *all);
    for (int colour = 0; colour < LPV_FIXTURE_COLOURS; colour++) {
        float *read = lpv_fixture_read(lpv, lpv->injection.injected, colour);
        memcpy(all + (size_t)colour * one, read, one * sizeof *all);
        free(read);
    }
    *count = LPV_FIXTURE_COLOURS * one;
    return all;
}

static float *injected_of(struct rsm_fixture *rsm, struct lpv *lpv, size_t *count)
{
    rsm_fixture_upload(rsm);
    lpv_fixture_render(lpv, rsm);
    return injected(lpv, count);
}

static double mebibytes(struct gpu *gpu, gpu_image image)
{
    const struct gpu_image_desc *desc = gpu_image_info(gpu, image);
    return (double)desc->width * desc->height * desc->depth * gpu_format_bytes(desc->format) /
           (1 << 20);
}

// Martin 2012, sec. 5.8: three grids of 32³ cells, 0.75 MiB each in two bands, 1.75 in three, and a
// geometry volume of 0.25 MiB for each of two directions.
TEST_GPU(lpv_volumes_of_half_floats_have_the_papers_size)
{
    const struct {
        const char *gi;
        double grid;
    } cases[] = { { "lpv:dim=32,precision=half", 0.75 }, { "holpv:dim=32,precision=half", 1.75 } };
    for (int i = 0; i < 2; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, cases[i].gi);
        CHECK(mebibytes(gpu, lpv->injection.injected) == cases[i].grid);
        CHECK(mebibytes(gpu, lpv->propagation.steps[0]) == cases[i].grid);
        CHECK(mebibytes(gpu, lpv->cascades[0].light) == cases[i].grid);
        CHECK(mebibytes(gpu, lpv->cascades[0].geometry.volume) == 0.5);
        CHECK(!lpv->cascades[0].coarser); // each cascade adds another
        assert_int_equal(lpv->propagation.steps[1].id, 0);
        lpv_fixture_destroy(lpv);
    }
}

TEST_GPU(lpv_injection_is_independent_of_order)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, "holpv:dim=8,steps=1,precision=float");
    size_t count;
    float *before = injected_of(&rsm, lpv, &count), *again = injected_of(&rsm, lpv, &count);
    assert_memory_equal(before, again, count * sizeof *before);
    struct frame_emitter points[POINTS], reversed[POINTS];
    scatter_points(points);
    for (int i = 0; i < POINTS; i++) reversed[i] = points[POINTS - 1 - i];
    free(before);
    rsm_fixture_set_emitters(&rsm, points, POINTS);
    before = injected_of(&rsm, lpv, &count);
    rsm_fixture_set_emitters(&rsm, reversed, POINTS);
    // The same lights in reverse order.
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        const struct rsm_fixture_texel texel = rsm.texels[i];
        rsm.texels[i] = rsm.texels[SIZE * SIZE + i];
        rsm.texels[SIZE * SIZE + i] = texel;
    }
    const struct rsm_face face = rsm.faces[0];
    rsm.faces[0] = rsm.faces[1];
    rsm.faces[1] = face;
    float *swapped = injected_of(&rsm, lpv, &count);
    assert_memory_equal(before, swapped, count * sizeof *before);
    free(before);
    free(again);
    free(swapped);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_half_the_light_is_half_the_grid_to_the_bit)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, "holpv:dim=8,steps=1,precision=float");
    size_t count;
    float *full = injected_of(&rsm, lpv, &count);
    for (int face = 0; face < 2; face++)
        rsm.faces[face].intensity = glms_vec3_scale(rsm.faces[face].intensity, 0.5f);
    float *half = injected_of(&rsm, lpv, &count);
    for (size_t i = 0; i < count; i++) CHECK(half[i] == 0.5f * full[i]);
    free(full);
    free(half);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

// All texels of a face in one cell, maximum number of steps: half floats end at 65504.
TEST_GPU(lpv_half_floats_represent_any_flux)
{
    static const char *const gis[] = { "lpv:dim=8,steps=128,precision=half,focus=0",
                                       "lpv:dim=8,steps=128,precision=half,focus=1",
                                       "holpv:dim=8,steps=128,precision=half,focus=0",
                                       "holpv:dim=8,steps=128,precision=half,focus=1" };
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    rsm_fixture_set_face(&rsm, 0, vec3_of(-0.1f, 2, 3), vec3_of(0.01f, 0, 0), vec3_of(0, 0.01f, 0),
                         vec3_of(0, 0, 0.01f), vec3_of(3, 2, 1));
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        *rsm_fixture_texel(&rsm, 0, i % SIZE, i / SIZE) = (struct rsm_fixture_texel){
            .depth = 0.5f, .normal = vec3_of(0, 1, 0), .reflectance = { 255, 255, 255 }
        };
    rsm_fixture_upload(&rsm);
    rsm.view.rsm_face_count = 1;
    const vec3s intensity = rsm.faces[0].intensity;
    for (int i = 0; i < 4; i++) {
        struct lpv *lpv = lpv_fixture_create(gpu, gis[i]);
        float most = 0.0f;
        float *all[3];
        for (int k = 0; k < 3; k++) { // 2^-40, 1 and 2^40 of the light
            rsm.faces[0].intensity = glms_vec3_scale(intensity, ldexpf(1.0f, 40 * (k - 1)));
            rsm_fixture_upload(&rsm);
            lpv_fixture_render(lpv, &rsm);
            all[k] = lpv_fixture_read(lpv, lpv->cascades[0].light, 0);
        }
        const struct lpv_cascade *cascade = &lpv->cascades[0];
        const size_t count = lpv_cell_count(&cascade->grid) * (size_t)SH_COUNT(lpv->options.bands);
        for (size_t n = 0; n < count; n++) {
            CHECK(ldexpf(all[0][n], 40) == all[1][n] && all[1][n] == ldexpf(all[2][n], -40));
            most = fmaxf(most, fabsf(all[1][n]));
        }
        const float unit = cascade->params.fixed_from_flux * cascade->params.grid_from_fixed;
        print_message("%s: at most %g of 65504\n", gis[i], (double)(ldexpf(most, 40) * unit));
        CHECK(ldexpf(most, 40) * unit < 65504.0f / 8);
        for (int k = 0; k < 3; k++) free(all[k]);
        lpv_fixture_destroy(lpv);
    }
    rsm_fixture_finish(&rsm);
}

TEST_GPU(lpv_two_lights_are_the_sum_even_ten_thousand_times_apart)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, "holpv:dim=8,steps=1,precision=float");
    rsm.faces[1].intensity = glms_vec3_scale(rsm.faces[1].intensity, 1e4f);
    const vec3s dim = rsm.faces[0].intensity, bright = rsm.faces[1].intensity;
    size_t count;
    float *both = injected_of(&rsm, lpv, &count);
    rsm.faces[1].intensity = vec3_of(0, 0, 0);
    float *first = injected_of(&rsm, lpv, &count);
    rsm.faces[1].intensity = bright;
    rsm.faces[0].intensity = vec3_of(0, 0, 0);
    float *second = injected_of(&rsm, lpv, &count);
    rsm.faces[0].intensity = dim;
    for (size_t i = 0; i < count; i++)
        CHECK_NEAR((double)both[i], (double)first[i] + (double)second[i],
                   1e-6 * (fabs((double)second[i]) + fabs((double)first[i])) + 1e-2);
    // The faint light is accurate in cells that the strong light does not reach.
    size_t seen = 0;
    for (size_t i = 0; i < count; i++)
        if (second[i] == 0.0f && fabsf(first[i]) > 1.0f) {
            seen++;
            CHECK_RELATIVE((double)both[i], (double)first[i], 1e-2);
        }
    CHECK(seen > 10);
    free(both);
    free(first);
    free(second);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}

static void expect_black(struct lpv *lpv, struct rsm_fixture *rsm)
{
    float got[PIXELS * 3];
    lpv_fixture_render(lpv, rsm);
    rsm_fixture_read_irradiance(rsm, got);
    for (int i = 0; i < PIXELS * 3; i++) CHECK(got[i] == 0.0f);
}

TEST_GPU(lpv_without_light_or_scene_is_black_exactly)
{
    struct rsm_fixture rsm;
    scatter(&rsm, gpu);
    struct lpv *lpv = lpv_fixture_create(gpu, "holpv:dim=8,steps=4");
    lpv_fixture_render(lpv, &rsm); // leaves light in all images
    const struct box3 bounds = rsm.view.bounds;
    rsm.view.bounds = box3_empty();
    expect_black(lpv, &rsm);
    rsm.view.bounds = (struct box3){ bounds.min, bounds.min };
    expect_black(lpv, &rsm);
    rsm.view.bounds = bounds;
    for (int face = 0; face < 2; face++) rsm.faces[face].intensity = vec3_of(0, 0, 0);
    expect_black(lpv, &rsm);
    for (int face = 0; face < 2; face++) {
        rsm.faces[face].intensity = vec3_of(9, 9, 9);
        rsm_fixture_fill_face(&rsm, face, (struct rsm_fixture_texel){ .depth = 0 });
    }
    rsm_fixture_upload(&rsm);
    expect_black(lpv, &rsm);
    rsm.view.rsm_face_count = 0;
    expect_black(lpv, &rsm);
    lpv_fixture_destroy(lpv);
    rsm_fixture_finish(&rsm);
}
