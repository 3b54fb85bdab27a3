// Radiosity: rows of form factors, a furnace, lights that change.
#include "frame/frame_fixture.h"
#include "techniques/baked_fixture.h"

#include "core/half.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SMALL "radiosity:texels=2048,rays=100,sources=16"

// Below 0 it is sunk into the floor.
static void add_block(struct frame_fixture *s, float bottom)
{
    fixture_box(s, vec3_of(-0.4f, bottom, -0.6f), vec3_of(0.8f, bottom + 1.2f, 0.5f), false,
                fixture_emissive(s, 0.5f, 0));
}

// ---- the bake

static void check_rows(const struct tensors *bake)
{
    const struct tensor *factor = tensors_find(bake, "texels/factor");
    const uint64_t texels = factor->shape[0], sources = factor->shape[1];
    double worst = 0.0;
    for (uint64_t i = 0; i < texels; i++) {
        double sum = 0.0;
        for (uint64_t k = 0; k < sources; k++)
            sum += (double)float_from_half(((const uint16_t *)factor->data)[3 * (i * sources + k)]);
        worst = fmax(worst, fabs(sum - 1.0));
    }
    print_message("%u rows sum to 1 within %.2g\n", (unsigned)texels, worst);
    CHECK(worst < 1e-3);
}

TEST_GPU(rows_of_a_closed_room_sum_to_one)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init_furnace(&s, gpu, 0.5f, 10);
    add_block(&s, 0.4f);
    baked_fixture_open(&run, &s, SMALL);
    check_rows(run.baked.bakes.of_term[0]);
    baked_fixture_close(&run, &s);
}

// ---- light

TEST_GPU(furnace_has_the_emission_over_one_minus_the_albedo)
{
    static const float ALBEDO[] = { 0.5f, 0.8f };
    for (int i = 0; i < 2; i++) {
        struct frame_fixture s;
        struct baked_fixture run;
        fixture_init_furnace(&s, gpu, ALBEDO[i], 10);
        baked_fixture_open(&run, &s, "radiosity:texels=2048");
        fixture_render(&s);
        const double expected = GLM_PI * 10 / (1 - (double)ALBEDO[i]);
        float *e = fixture_read(&s, READ_IRRADIANCE);
        double least = HUGE_VAL, most = 0;
        for (size_t p = 0; p < 3 * (size_t)s.width * s.height; p++) {
            least = fmin(least, (double)e[p] / expected);
            most = fmax(most, (double)e[p] / expected);
        }
        print_message("albedo %.1f: %.4f to %.4f of L/(1 - albedo)\n", (double)ALBEDO[i], least,
                      most);
        CHECK(least > 0.99 && most < 1.01);
        free(e);
        baked_fixture_close(&run, &s);
    }
}

static double mean_irradiance(struct frame_fixture *s)
{
    fixture_render(s);
    float *e = fixture_read(s, READ_IRRADIANCE);
    const size_t count = 3 * (size_t)s->width * s->height;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)e[i] / (double)count;
    free(e);
    return sum;
}

TEST_GPU(a_light_that_is_switched_off_leaves_nothing_in_the_next_frame)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init_furnace(&s, gpu, 0.7f, 0);
    struct world_light *light = fixture_add_point(&s, vec3_of(0, 2, 0), vec3_of(100, 100, 100));
    baked_fixture_open(&run, &s, SMALL);
    const double lit = mean_irradiance(&s), again = mean_irradiance(&s);
    CHECK(lit > 1.0 && lit == again);
    light->intensity = vec3_of(0, 0, 0);
    CHECK(mean_irradiance(&s) == 0.0);
    light->intensity = vec3_of(100, 100, 100);
    CHECK(mean_irradiance(&s) == lit);
    baked_fixture_close(&run, &s);
}

// Passes that a frame records.
static uint64_t passes_of_frame(struct frame_fixture *s)
{
    const uint64_t before = gpu_counters(s->gpu)->passes;
    fixture_render(s);
    return gpu_counters(s->gpu)->passes - before;
}

TEST_GPU(a_still_scene_costs_the_lookup_alone)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init_furnace(&s, gpu, 0.7f, 10);
    baked_fixture_open(&run, &s, SMALL);
    fixture_render(&s);
    const uint64_t still = passes_of_frame(&s);
    fixture_add_point(&s, vec3_of(0, 2, 0), vec3_of(100, 100, 100));
    fixture_render(&s);
    s.lights[0].intensity = vec3_of(50, 50, 50);
    const uint64_t changed = passes_of_frame(&s);
    // direct, bounces, gather, light_map; the shadow maps of the light are kept.
    CHECK(changed >= still + 4);
    CHECK(passes_of_frame(&s) <= changed - 4);
    baked_fixture_close(&run, &s);
}

// The floor beside the block has the light of texels whose middle is under it.
TEST_GPU(nothing_is_black_beside_a_sunk_block)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init_furnace(&s, gpu, 0.5f, 10);
    add_block(&s, -0.3f);
    baked_fixture_open(&run, &s, SMALL);
    fixture_render(&s);
    float *e = fixture_read(&s, READ_IRRADIANCE);
    double least = HUGE_VAL, sum = 0.0;
    const size_t count = 3 * (size_t)s.width * s.height;
    for (size_t i = 0; i < count; i++) {
        least = fmin(least, (double)e[i]);
        sum += (double)e[i] / (double)count;
    }
    print_message("beside a sunk block at least %.3f of the mean irradiance\n", least / sum);
    CHECK(least > 0.3 * sum);
    free(e);
    baked_fixture_close(&run, &s);
}

// A slab over a wall that reaches into it, with a moulding along its edge: rays from inside of the
// slab meet the front of the wall's top. A third of the moulding's underside is outside of it.
TEST_GPU(nothing_is_black_under_overlapping_solids)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init_furnace(&s, gpu, 0.5f, 10);
    const int stone = fixture_emissive(&s, 0.5f, 0);
    fixture_box(&s, vec3_of(-2.1f, 0.8f, -1), vec3_of(2.1f, 1.1f, 0), false, stone);
    fixture_box(&s, vec3_of(-2.1f, 0.94f, -0.2f), vec3_of(2.1f, 1.16f, 0.1f), false, stone);
    fixture_box(&s, vec3_of(-2.1f, -0.1f, -0.9f), vec3_of(2.1f, 0.85f, -0.1f), false, stone);
    fixture_look(&s, vec3_of(0, 0.7f, 0.35f), vec3_of(0.1f, 0.94f, 0.05f));
    s.input.camera.vertical_fov_rad = 0.2f;
    baked_fixture_open(&run, &s, "radiosity:density=3.3,rays=256,sources=16");
    const double mean = mean_irradiance(&s), room_e = GLM_PI * 10 / (1 - 0.5);
    print_message("under the moulding %.3f of the room's irradiance\n", mean / room_e);
    CHECK(mean > 0.4 * room_e && mean < room_e);
    baked_fixture_close(&run, &s);
}

// ---- specular light

static int metal(struct frame_fixture *s, float roughness)
{
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(1, 1, 1), 1);
    m.metallic = 1;
    m.roughness = roughness;
    return fixture_material(s, &m);
}

// The mean of 5 × 5 pixels in the middle: single ones have the noise of their texels, some percent.
static float middle_specular(struct frame_fixture *s)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < 25; i++)
        sum +=
            fixture_pixel(s, READ_SPECULAR, s->width / 2 + i % 5 - 2, s->height / 2 + i / 5 - 2).x;
    return sum / 25.0f;
}

TEST_GPU(metal_reflects_uniform_light_whole)
{
    static const float ROUGHNESS[] = { 0.1f, 0.5f, 1.0f };
    for (int i = 0; i < 3; i++) {
        struct frame_fixture s;
        struct baked_fixture run;
        fixture_init_furnace(&s, gpu, 0, 10);
        fixture_box(&s, vec3_of(-0.4f, 0.4f, -0.6f), vec3_of(0.8f, 1.6f, 0.5f), false,
                    metal(&s, ROUGHNESS[i]));
        baked_fixture_open(&run, &s, "radiosity:texels=2048");
        fixture_render(&s);
        const float light = middle_specular(&s);
        const vec3s wall = fixture_pixel(&s, READ_SPECULAR, 0, 0);
        print_message("roughness %.1f: %.3f of the light\n", (double)ROUGHNESS[i],
                      (double)light / 10);
        CHECK_NEAR(light, 10.0, 0.2);
        CHECK(wall.x == 0.0f);
        baked_fixture_close(&run, &s);
    }
}

// Radiance that a metal floor reflects to an eye on one side of it; a panel at +x emits light.
static double seen_from(struct gpu *gpu, float roughness, float eye, const char *text)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init(&s, gpu);
    fixture_floor(&s, 1, metal(&s, roughness));
    fixture_quad(&s, vec3_of(2, 0, -3), vec3_of(2, 0, 3), vec3_of(2, 3, 3), vec3_of(2, 3, -3),
                 fixture_emissive(&s, 0, 10));
    fixture_look(&s, vec3_of(eye, 0.8f, 0), vec3_of(0, 0, 0));
    baked_fixture_open(&run, &s, text);
    fixture_render(&s);
    const double seen = (double)fixture_pixel(&s, READ_SPECULAR, s.width / 2, s.height / 2).x;
    baked_fixture_close(&run, &s);
    return seen;
}

TEST_GPU(metal_reflects_the_side_that_light_comes_from)
{
    const double towards = seen_from(gpu, 0.3f, -1, "radiosity:texels=2048");
    const double away = seen_from(gpu, 0.3f, 1, "radiosity:texels=2048");
    print_message("towards the light %.2f cd/m2, away from it %.2f\n", towards, away);
    CHECK(towards > 3 * away && towards > 1.0 && towards < 10.0 && away >= 0.0);
    CHECK(seen_from(gpu, 0.3f, -1, "radiosity:texels=2048,specular=false") == 0.0);
}

// Radiance of a metal floor below a panel 1 m wide and 2 m above it, for a view at an angle from
// the normal, per E/π.
static double seen_below_a_panel(struct gpu *gpu, float angle)
{
    struct frame_fixture s;
    struct baked_fixture run;
    fixture_init(&s, gpu);
    fixture_floor(&s, 1, metal(&s, 0.4f));
    fixture_quad(&s, vec3_of(-0.5f, 2, -0.5f), vec3_of(0.5f, 2, -0.5f), vec3_of(0.5f, 2, 0.5f),
                 vec3_of(-0.5f, 2, 0.5f), fixture_emissive(&s, 0, 100));
    fixture_look(&s, vec3_of(1.5f * sinf(angle), 1.5f * cosf(angle), 0), vec3_of(0, 0, 0));
    baked_fixture_open(&run, &s, "radiosity:texels=2048");
    fixture_render(&s);
    const double e = (double)fixture_pixel(&s, READ_IRRADIANCE, s.width / 2, s.height / 2).x;
    const double seen = (double)middle_specular(&s) * GLM_PI / e;
    baked_fixture_close(&run, &s);
    return seen;
}

// The vector irradiance is that of uniform light; the fluence tells them apart.
TEST_GPU(metal_reflects_light_from_overhead_upwards)
{
    const double upwards = seen_below_a_panel(gpu, 0.2f), sideways = seen_below_a_panel(gpu, 1.3f);
    print_message("radiance of a floor below a panel: %.2f E/pi from above, %.3f from the side\n",
                  upwards, sideways);
    CHECK(upwards > 1.5);
    CHECK(sideways >= 0.0 && sideways < 0.1);
}

// Two bands have no image of the panel: mirrors have the mean radiance, without a step to lobes.
TEST_GPU(mirrors_reflect_the_mean_radiance_and_rougher_metal_the_direction)
{
    static const float ROUGHNESS[] = { 0.0f, 0.1f, 0.2f, 0.3f };
    double last = 0;
    for (int i = 0; i < 4; i++) {
        const double towards = seen_from(gpu, ROUGHNESS[i], -1, "radiosity:texels=2048");
        const double away = seen_from(gpu, ROUGHNESS[i], 1, "radiosity:texels=2048");
        const double contrast = (towards - away) / (towards + away);
        print_message("roughness %.1f: towards the light %.2f cd/m2, away from it %.2f\n",
                      (double)ROUGHNESS[i], towards, away);
        CHECK(i == 0 ? fabs(contrast) < 0.02 : contrast > last);
        CHECK(towards > 0.1);
        last = contrast;
    }
}
