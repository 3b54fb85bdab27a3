// The gather of ort: the same sums in any order of the maps and in any number of parts, in bytes
// within their rounding, in a time that does not depend on the number of lights.
#include "frame/frame_fixture.h"
#include "techniques/baked_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/ort/ort_tensors.h"

#include "core/half.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SMALL "ort:texels=1024,offsets=100"

static void lit_room(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init_furnace(s, gpu, 0.7f, 0);
    fixture_box(s, vec3_of(-0.4f, 0.4f, -0.6f), vec3_of(0.8f, 1.6f, 0.5f), false,
                fixture_matte(s, vec3_of(0.8f, 0.4f, 0.2f)));
    fixture_add_point(s, vec3_of(1, 2.5f, 1), vec3_of(100, 50, 20));
}

static size_t numbers_of(const struct frame_fixture *s)
{
    return 3 * (size_t)s->width * s->height;
}

// ---- light

TEST_GPU(furnace_has_the_emission_over_one_minus_the_albedo)
{
    static const float ALBEDO[] = { 0.5f, 0.8f };
    for (int i = 0; i < 2; i++) {
        struct frame_fixture s;
        struct baked_fixture run;
        fixture_init_furnace(&s, gpu, ALBEDO[i], 10);
        baked_fixture_open(&run, &s, SMALL);
        fixture_render(&s);
        const double expected = GLM_PI * 10 / (1 - (double)ALBEDO[i]);
        float *e = fixture_read(&s, READ_IRRADIANCE);
        double least = HUGE_VAL, most = 0;
        for (size_t p = 0; p < numbers_of(&s); p++) {
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
    double sum = 0.0;
    for (size_t i = 0; i < numbers_of(s); i++) sum += (double)e[i] / (double)numbers_of(s);
    free(e);
    return sum;
}

TEST_GPU(twice_the_light_is_twice_the_irradiance_and_none_is_none)
{
    struct frame_fixture s;
    struct baked_fixture run;
    lit_room(&s, gpu);
    baked_fixture_open(&run, &s, SMALL);
    const double once = mean_irradiance(&s);
    s.lights[0].intensity = glms_vec3_scale(s.lights[0].intensity, 2);
    const double twice = mean_irradiance(&s);
    print_message("%.4f lux, of twice the light %.6f times that\n", once, twice / once);
    CHECK(once > 1.0);
    CHECK_RELATIVE(twice, 2 * once, 1e-3); // half floats of the light map
    s.lights[0].intensity = vec3_of(0, 0, 0);
    CHECK(mean_irradiance(&s) == 0.0);
    baked_fixture_close(&run, &s);
}

// ---- orders, parts, precision

static float *image_of(struct gpu *gpu, const char *text)
{
    struct frame_fixture s;
    lit_room(&s, gpu);
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, text); // keeps the bake
    fixture_render(&s);
    float *e = fixture_read(&s, READ_IRRADIANCE);
    gi_destroy(gi);
    fixture_finish(&s);
    return e;
}

// Sums of floats in another order may round to the next half float, which texels, the light map and
// the image have in turn.
TEST_GPU(orders_and_parts_give_one_image)
{
    static const char *const OTHERS[] = { ",order=slices", ",parts=2", ",parts=8",
                                          ",order=slices,parts=2", ",order=slices,parts=8" };
    const double rounding = 3 * 0x1p-10;
    float *expected = image_of(gpu, SMALL);
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
        char text[128];
        double worst = 0.0;
        snprintf(text, sizeof text, "%s%s", SMALL, OTHERS[i]);
        float *e = image_of(gpu, text);
        for (size_t p = 0; p < (size_t)3 * 32 * 32; p++)
            worst = fmax(worst, fabs((double)e[p] / (double)expected[p] - 1));
        print_message("%s differs by %.2g\n", text, worst);
        CHECK(worst <= rounding);
        free(e);
    }
    free(expected);
}

// Half a step of 1/255 of each map's largest weight, in units of the first-order light.
static double rounding_of_bytes(const struct tensors *bake)
{
    const struct tensor *maps = tensors_find(bake, ORT_MAPS);
    const size_t texels = maps->shape[0], offsets = maps->shape[1];
    const uint16_t *weight = maps->data;
    double sum = 0.0;
    for (size_t k = 0; k < offsets; k++) {
        double most = 0.0;
        for (size_t i = 0; i < 3 * texels; i++)
            most = fmax(most, (double)float_from_half(weight[3 * (i / 3 * offsets + k) + i % 3]));
        sum += 0.5 * most / 255 / (double)ORT_MAP_SCALE;
    }
    return sum;
}

// In the furnace the first-order light of all texels is πL.
TEST_GPU(bytes_differ_from_halves_by_their_rounding)
{
    float *image[2];
    double bound = 0.0, worst = 0.0, most = 0.0;
    for (int bytes = 0; bytes < 2; bytes++) {
        struct frame_fixture s;
        struct baked_fixture run;
        fixture_init_furnace(&s, gpu, 0.5f, 10);
        baked_fixture_open(&run, &s, bytes ? SMALL ",precision=byte" : SMALL);
        fixture_render(&s);
        image[bytes] = fixture_read(&s, READ_IRRADIANCE);
        bound = GLM_PI * 10 * rounding_of_bytes(run.baked.bakes.of_term[0]);
        baked_fixture_close(&run, &s);
    }
    for (size_t p = 0; p < (size_t)3 * 32 * 32; p++) {
        worst = fmax(worst, fabs((double)image[0][p] - (double)image[1][p]));
        most = fmax(most, (double)image[0][p]);
    }
    print_message("bytes differ by %.4f of at most %.4f lux, bound %.4f\n", worst, most, bound);
    CHECK(bound < 0.05 * most && worst <= bound + 3 * 0x1p-10 * most);
    free(image[0]);
    free(image[1]);
}

// ---- time

enum { FRAMES = 5 };

static double gather_ms(struct gpu *gpu)
{
    struct gpu_timing t[128];
    const int count = gpu_frame_timings(gpu, t, 128);
    for (int i = 0; i < count; i++)
        if (strstr(t[i].name, "gather")) return t[i].ms;
    fail_msg("the frame has no pass `gather`");
    return 0.0;
}

// Fastest of some frames, whose light differs.
static double fastest_gather(struct frame_fixture *s, struct world_light *lights, int count)
{
    double least = HUGE_VAL;
    s->input.lights = lights;
    s->input.light_count = count;
    for (int i = 0; i < FRAMES; i++) {
        lights[0].intensity.x += 1;
        fixture_render(s);
        least = fmin(least, gather_ms(s->gpu));
    }
    return least;
}

TEST_GPU(time_of_the_gather_does_not_depend_on_lights)
{
    static struct world_light lights[FRAME_MAX_LIGHTS];
    struct frame_fixture s;
    struct baked_fixture run;
    if (!gpu_limits(gpu)->timestamps) test_skip("no timestamps");
    lit_room(&s, gpu);
    for (int i = 0; i < FRAME_MAX_LIGHTS; i++) {
        lights[i] = s.lights[0];
        lights[i].position = vec3_of(1.5f * cosf((float)i), 2.5f, 1.5f * sinf((float)i));
    }
    baked_fixture_open(&run, &s, "ort:texels=4096,offsets=100");
    const double one = fastest_gather(&s, lights, 1), ten = fastest_gather(&s, lights, 10),
                 all = fastest_gather(&s, lights, FRAME_MAX_LIGHTS);
    print_message("gather: %.3f ms of 1 light, %.3f of 10, %.3f of %d\n", one, ten, all,
                  FRAME_MAX_LIGHTS);
    CHECK(fmax(ten, all) <= 2 * test_time_factor() * one);
    baked_fixture_close(&run, &s);
}
