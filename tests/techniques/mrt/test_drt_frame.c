// Delta radiance transfer in whole frames.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/gi_spec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 32, FLOATS = SIZE * SIZE * 3, TEXT = 512 };

#define DICTIONARY                                                                                 \
    ":texels=8,rays=1024,modes=24,lightfield_positions=4,lightfield_directions=6,"                 \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=8,"         \
    "block_probes=2"

// Each side of the hollow box is a face.
#define HOLLOW                                                                                     \
    ":map=single,texels=8,rays=1024,modes=24,lightfield_positions=4,lightfield_directions=6,"      \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=12,"        \
    "block_probes=2"

struct room {
    const char *technique, *options;
    bool box;
    float power;
    int frames;
};

// A closed room, with a box in it or without. The caller frees the irradiance.
static float *irradiance_of(struct gpu *gpu, struct room room)
{
    struct frame_fixture s;
    struct gi_spec spec;
    char text[TEXT];
    fixture_init(&s, gpu);
    const int material = fixture_matte(&s, vec3_of(0.6f, 0.5f, 0.4f));
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, material);
    if (room.box)
        fixture_box(&s, vec3_of(-0.5f, 0, -0.5f), vec3_of(0.6f, 1.3f, 0.4f), false, material);
    fixture_look(&s, vec3_of(-1.5f, 2.5f, 1.5f), vec3_of(0.5f, 0, -0.5f));
    fixture_add_point(&s, vec3_of(-1.2f, 2.2f, -1),
                      glms_vec3_scale(vec3_of(100, 60, 20), room.power));
    snprintf(text, sizeof text, "%s" DICTIONARY "%s", room.technique, room.options);
    fixture_open(&s);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    struct gi *gi = gi_fixture_create(s.gpu, &spec, &s.pose, SIZE, SIZE);
    assert_non_null(gi);
    s.indirect = gi_hook(gi);
    gi_spec_finish(&spec);
    for (int i = 0; i < room.frames; i++) fixture_render(&s);
    float *out = fixture_read(&s, READ_IRRADIANCE);
    gi_destroy(gi);
    fixture_finish(&s);
    return out;
}

static double sum_of(const float *e)
{
    double sum = 0.0;
    for (int i = 0; i < FLOATS; i++) {
        CHECK(isfinite(e[i]) && e[i] >= 0.0f);
        sum += (double)e[i];
    }
    return sum;
}

TEST_GPU(drt_without_objects_is_mrt)
{
    float *mrt = irradiance_of(gpu, (struct room){ "mrt", "", false, 1, 1 });
    float *drt = irradiance_of(gpu, (struct room){ "drt", "", false, 1, 1 });
    CHECK(sum_of(mrt) > 0.0);
    CHECK(memcmp(mrt, drt, FLOATS * sizeof *mrt) == 0);
    free(mrt);
    free(drt);
}

// Occlusion takes light, reflection gives some of it back.
TEST_GPU(drt_operators_change_light_as_they_say)
{
    float *off =
        irradiance_of(gpu, (struct room){ "drt", ",occlusion=false,reflection=false", true, 1, 1 });
    float *dark = irradiance_of(gpu, (struct room){ "drt", ",reflection=false", true, 1, 1 });
    float *both = irradiance_of(gpu, (struct room){ "drt", "", true, 1, 1 });
    const double none = sum_of(off), shadowed = sum_of(dark), all = sum_of(both);
    print_message("occlusion leaves %.3f of the light, reflection brings it to %.3f\n",
                  shadowed / none, all / none);
    CHECK(shadowed < 0.95 * none);
    CHECK(all > 1.05 * shadowed && all < none);
    free(off);
    free(dark);
    free(both);
}

TEST_GPU(drt_is_linear_in_light_and_still)
{
    float *one = irradiance_of(gpu, (struct room){ "drt", "", true, 1, 1 });
    float *twice = irradiance_of(gpu, (struct room){ "drt", "", true, 2, 1 });
    float *later = irradiance_of(gpu, (struct room){ "drt", "", true, 1, 3 });
    CHECK(sum_of(one) > 0.0);
    for (int i = 0; i < FLOATS; i++) CHECK_NEAR(twice[i], 2.0f * one[i], 2e-3f * one[i] + 1e-2f);
    CHECK(memcmp(one, later, FLOATS * sizeof *one) == 0);
    free(one);
    free(twice);
    free(later);
}

// Feedback from frame to frame converges to the bounces of one frame.
TEST_GPU(drt_feedback_converges)
{
    float *bounces = irradiance_of(gpu, (struct room){ "drt", ",bounces=16", true, 1, 1 });
    float *feedback =
        irradiance_of(gpu, (struct room){ "drt", ",bounces=1,feedback=true", true, 1, 16 });
    CHECK_RELATIVE(sum_of(bounces), sum_of(feedback), 5e-3);
    free(bounces);
    free(feedback);
}

// The camera in a closed hollow box, which is clutter; a lit room is around it. Returns the
// irradiance; the caller frees it.
static float *irradiance_in_hollow(struct gpu *gpu, const char *text)
{
    struct frame_fixture s;
    struct gi_spec spec;
    fixture_init(&s, gpu);
    const int material = fixture_matte(&s, vec3_of(0.6f, 0.5f, 0.4f));
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, material);
    fixture_box(&s, vec3_of(-0.8f, 0.6f, -0.8f), vec3_of(0.8f, 2.2f, 0.8f), false, material);
    fixture_box(&s, vec3_of(-0.7f, 0.7f, -0.7f), vec3_of(0.7f, 2.1f, 0.7f), true, material);
    fixture_look(&s, vec3_of(-0.5f, 1.9f, 0.5f), vec3_of(0.5f, 0.8f, -0.5f));
    fixture_add_point(&s, vec3_of(-1.5f, 2.7f, -1.2f), vec3_of(100, 60, 20));
    fixture_open(&s);
    CHECK(gi_spec_parse(&spec, test_host(), text));
    struct gi *gi = gi_fixture_create(s.gpu, &spec, &s.pose, SIZE, SIZE);
    assert_non_null(gi);
    s.indirect = gi_hook(gi);
    gi_spec_finish(&spec);
    fixture_render(&s);
    float *out = fixture_read(&s, READ_IRRADIANCE);
    gi_destroy(gi);
    fixture_finish(&s);
    return out;
}

// mrt's light passes through.
TEST_GPU(drt_has_no_light_in_closed_clutter)
{
    float *through = irradiance_in_hollow(gpu, "mrt" HOLLOW);
    float *inside = irradiance_in_hollow(gpu, "drt" HOLLOW);
    CHECK(sum_of(through) > 0.0);
    CHECK(sum_of(inside) == 0.0);
    free(inside);
    free(through);
}
