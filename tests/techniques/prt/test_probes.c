// Transfer matrices of points in free space, and what moves, which they light.
#include "techniques/prt/prt_fixture.h"

#include "core/half.h"
#include "core/sh.h"
#include "techniques/baked_fixture.h"
#include "techniques/common/probes/grid.h"
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <math.h>
#include <stdlib.h>

// ---- matrices

struct probes {
    const uint16_t *matrix;
    const float *place, *emitted;
    size_t count, rows, numbers;
};

static struct probes probes_of(const struct prt_baked *baked)
{
    const struct tensor *matrix = tensors_find(baked->tensors, PRT_PROBE_MATRIX);
    return (struct probes){ .matrix = matrix->data,
                            .place = tensors_find(baked->tensors, PRT_PROBE_PLACE)->data,
                            .emitted = tensors_find(baked->tensors, PRT_PROBE_EMITTED)->data,
                            .count = matrix->shape[0],
                            .rows = matrix->shape[1],
                            .numbers = matrix->shape[2] };
}

static double entry(const struct probes *p, size_t probe, size_t row, size_t number)
{
    return (double)float_from_half(p->matrix[(probe * p->rows + row) * p->numbers + number]);
}

// Small surfaces occlude almost none of the sky: it arrives unchanged.
TEST(matrices_of_an_open_scene_are_the_identity)
{
    struct prt_fixture f;
    double worst = 0;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 0.02f, prt_fixture_diffuse(&f, 0.5f));
    fixture_box(&f.s, vec3_of(3, 3, 3), vec3_of(3.02f, 3.02f, 3.02f), false,
                prt_fixture_diffuse(&f, 0.5f));
    prt_fixture_open(&f, "texels=64,rays=2048,coefficients=25,glossy=true,probe_spacing=1.1");
    struct prt_baked baked = prt_fixture_bake(&f, "transfer=shadowed", 0);
    const struct probes p = probes_of(&baked);
    CHECK(p.count == 27 && p.rows == 25 && p.numbers == 25);
    for (size_t i = 0; i < p.count; i++) {
        CHECK(p.place[4 * i + 3] == 1);
        for (size_t j = 0; j < p.rows; j++)
            for (size_t k = 0; k < p.numbers; k++)
                worst = fmax(worst, fabs(entry(&p, i, j, k) - (j == k ? 1 : 0)));
    }
    print_message("%zu probes: %.4f off\n", p.count, worst);
    CHECK(worst < 0.01);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// A large black floor hides the lower half of the sky: radiance of the sky that arrives from a
// direction above is that which is sent, in the mean over the upper half.
TEST(a_black_floor_hides_half_of_the_sky)
{
    struct prt_fixture f;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 200, prt_fixture_diffuse(&f, 0));
    fixture_box(&f.s, vec3_of(0, 0.4f, 0), vec3_of(0.01f, 0.41f, 0.01f), false,
                prt_fixture_diffuse(&f, 0));
    prt_fixture_open(&f, "texels=64,rays=2048,coefficients=25,glossy=true,probe_spacing=100");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    const struct probes p = probes_of(&baked);
    // Band 0 by band 0: the share of the sphere. Band 1, +y, by band 0: its mean over the half,
    // √3/4.
    const double share = entry(&p, 0, 0, 0), up = entry(&p, 0, 1, 0);
    print_message("share of the sky %.4f, upwards %.4f\n", share, up);
    CHECK_NEAR(share, 0.5, 0.01);
    CHECK_NEAR(up, sqrt(3) / 4, 0.01);
    for (int c = 1; c < 4; c++) CHECK(entry(&p, 0, 0, (size_t)c) == 0);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

TEST(probes_of_a_white_scene_in_a_white_sky_see_its_radiance)
{
    struct prt_fixture f;
    double worst = 0;
    prt_fixture_init(&f);
    fixture_floor(&f.s, 2, prt_fixture_diffuse(&f, 1));
    fixture_box(&f.s, vec3_of(-1, 0, -0.5f), vec3_of(0, 1, 0.5f), false,
                prt_fixture_diffuse(&f, 1));
    prt_fixture_open(&f, "density=8,rays=512,bounces=64,threshold=0,probe_spacing=0.5");
    struct prt_baked baked = prt_fixture_bake(&f, "", 0);
    const struct probes p = probes_of(&baked);
    for (size_t i = 0; i < p.count; i++) {
        if (!(p.place[4 * i + 3] > 0)) continue;
        for (size_t j = 0; j < p.rows; j++)
            worst = fmax(worst, fabs(entry(&p, i, j, 0) + entry(&p, i, j, 1) - (j == 0 ? 1 : 0)));
    }
    print_message("%zu probes: %.4f off\n", p.count, worst);
    CHECK(worst < 0.02);
    prt_baked_finish(&baked);
    prt_fixture_close(&f);
}

// ---- what moves

// Radiance is the same from everywhere, emitted and reflected.
TEST_GPU(an_object_in_a_furnace_has_the_walls_irradiance)
{
    trial_object_in_furnace(gpu, "prt:texels=4096,threshold=0.0001,bounces=64");
}

// A metal without losses in a uniform sky cannot be told from it.
TEST_GPU(a_moving_metal_in_a_uniform_sky_reflects_its_radiance)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct material m = material_default();
    double least = HUGE_VAL, most = 0;
    fixture_init(&s, gpu);
    s.input.want_id_layer = true;
    fixture_floor(&s, 0.02f, fixture_emissive(&s, 0.5f, 0));
    fixture_box(&s, vec3_of(3, 3, 3), vec3_of(3.02f, 3.02f, 3.02f), false,
                fixture_emissive(&s, 0.5f, 0));
    m.metallic = 1;
    m.roughness = 0.4f;
    const int object =
        trial_add_movable_box(&s, vec3_of(1.5f, 1.5f, 1.5f), 1, fixture_material(&s, &m));
    s.input.environment.sky = vec3_of(100, 100, 100);
    fixture_look(&s, vec3_of(2.7f, 2.5f, 3.4f), vec3_of(1.5f, 1.5f, 1.5f));
    baked_fixture_open(&run, &s, "prt:texels=256,glossy=true,rays=1024,probe_spacing=1.1");
    fixture_render(&s);
    float *id = fixture_read(&s, READ_ID), *light = fixture_read(&s, READ_COLOR);
    for (size_t i = 0; i < (size_t)s.width * s.height; i++) {
        if ((int)id[2 * i] < object) continue;
        least = fmin(least, (double)light[3 * i]);
        most = fmax(most, (double)light[3 * i]);
    }
    free(id);
    free(light);
    print_message("%.3f to %.3f\n", least, most);
    CHECK(least > 97 && most < 103);
    baked_fixture_close(&run, &s);
}
