// Shadows of pillars in the indirect light of @maze: irradiance of marked regions of the floor,
// against the reference.
#include "techniques/trials/light_trial.h"

#include <math.h>
#include <stdio.h>

#define DICTIONARY                                                                                 \
    ":texels=16,rays=1024,modes=32,lightfield_positions=4,lightfield_directions=6,"                \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=32,"        \
    "block_probes=2"

enum { SIZE = 8, SAMPLES = 64, TEXT = 512 };

struct region {
    const char *name, *scene;
    vec3s at;     // on the floor
    float half_m; // of its edge
};

// A camera above the floor that sees the region alone.
static void open_region(struct frame_fixture *s, struct gpu *gpu, const struct region *region)
{
    const float height = 1.0f;
    fixture_init(s, gpu);
    scene_destroy(s->scene);
    s->scene = scene_load(test_host(), region->scene);
    assert_non_null(s->scene);
    s->options.shadow_size = 512;
    s->width = s->height = SIZE;
    fixture_look(s, glms_vec3_add(region->at, vec3_of(0.0f, height, 0.01f)), region->at);
    s->input.camera.vertical_fov_rad = 2.0f * atanf(region->half_m / height);
}

// Lights of the scene as those of the frame.
static void take_lights(struct frame_fixture *s)
{
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    for (int i = 0; i < s->scene->light_count; i++) s->lights[i] = pose_light(&s->pose, i);
    s->input.light_count = s->scene->light_count;
    pose_finish(&s->pose);
}

static double mean_of(struct gpu *gpu, const struct region *region, const char *technique)
{
    struct frame_fixture s;
    char text[TEXT];
    open_region(&s, gpu, region);
    take_lights(&s);
    snprintf(text, sizeof text, "%s" DICTIONARY, technique);
    const struct trial_irradiance e = trial_technique(&s, text);
    fixture_finish(&s);
    return e.mean[1];
}

static double reference_of(struct gpu *gpu, const struct region *region)
{
    struct frame_fixture s;
    open_region(&s, gpu, region);
    const struct trial_irradiance e = trial_reference(&s, -1, SAMPLES);
    fixture_finish(&s);
    return e.mean[1];
}

// mrt lets light pass through pillars.
TEST_GPU(pillars_shadow_indirect_light)
{
    static const char scene[] = "@maze:blocks=2,pillars=4,light=point";
    static const struct {
        struct region region;
        double most; // error of drt
        double mrt;  // its least irradiance
    } cases[] = {
        // Behind a pillar, seen from the light.
        { { "cube with the light", scene, { { -1.15f, 0, 1.15f } }, 0.2f }, 0.15, 1.2 },
        // Seen from the opening. Light of openings is scaled by the share of its rays that pass,
        // wherever it comes from: beside the way that light takes to a shadow that is too much.
        { { "next cube", scene, { { 1.15f, 0, -3.66f } }, 0.2f }, 0.2, 2.5 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct region *region = &cases[i].region;
        const double expected = reference_of(gpu, region);
        const double mrt = mean_of(gpu, region, "mrt") / expected;
        const double drt = mean_of(gpu, region, "drt") / expected;
        print_message("%s: mrt %.3f, drt %.3f of the reference's %.1f lux\n", region->name, mrt,
                      drt, expected);
        CHECK(fabs(drt - 1.0) <= cases[i].most && mrt >= cases[i].mrt);
    }
}
