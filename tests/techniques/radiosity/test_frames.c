// Radiosity over frames: an update in one frame or spread over several, lights that are switched
// off or move.
#include "frame/frame_fixture.h"
#include "techniques/baked_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const vec3s LIT = { { 100, 100, 100 } };

// A closed room with a block, lit by a point light.
static struct world_light *room_open(struct frame_fixture *s, struct baked_fixture *run,
                                     struct gpu *gpu, int frames)
{
    char spec[64];
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(0.7f, 0.7f, 0.7f), 1);
    m.metallic = 0;
    m.roughness = 1;
    fixture_init(s, gpu);
    const int grey = fixture_material(s, &m);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, grey);
    fixture_box(s, vec3_of(-0.4f, 0, -0.6f), vec3_of(0.8f, 1.2f, 0.5f), false, grey);
    fixture_look(s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(1, 0.5f, -1));
    struct world_light *light = fixture_add_point(s, vec3_of(0, 2, 0), LIT);
    snprintf(spec, sizeof spec, "radiosity:texels=2048,rays=100,sources=16,frames=%d", frames);
    baked_fixture_open(run, s, spec);
    return light;
}

static size_t value_count(const struct frame_fixture *s)
{
    return 3 * (size_t)s->width * s->height;
}

// The caller frees it.
static float *next_frame(struct frame_fixture *s)
{
    fixture_render(s);
    return fixture_read(s, READ_IRRADIANCE);
}

static double mean_of(const struct frame_fixture *s, const float *e)
{
    double sum = 0.0;
    for (size_t i = 0; i < value_count(s); i++) sum += (double)e[i] / (double)value_count(s);
    return sum;
}

static double next_mean(struct frame_fixture *s)
{
    float *e = next_frame(s);
    const double mean = mean_of(s, e);
    free(e);
    return mean;
}

// Mean of the absolute differences.
static double change_of(const struct frame_fixture *s, const float *a, const float *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < value_count(s); i++)
        sum += fabs((double)a[i] - (double)b[i]) / (double)value_count(s);
    return sum;
}

static void check_switch(struct gpu *gpu, int frames)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct world_light *light = room_open(&s, &run, gpu, frames);
    const double lit = next_mean(&s);
    int passed = 0;
    light->intensity = vec3_of(0, 0, 0);
    for (double now = lit; now > 0.05 * lit && passed <= 16; passed++) now = next_mean(&s);
    print_message("frames=%d: 95 %% of a switched-off light is gone after %d frames\n", frames,
                  passed);
    CHECK(lit > 1.0 && passed <= 16 && passed <= frames);
    for (; passed < frames; passed++) next_mean(&s);
    CHECK(next_mean(&s) == 0.0);
    light->intensity = LIT;
    for (int i = 1; i < frames; i++) next_mean(&s);
    CHECK(next_mean(&s) == lit);
    baked_fixture_close(&run, &s);
}

TEST_GPU(a_light_that_is_switched_off_is_gone_within_16_frames)
{
    check_switch(gpu, 1);
    check_switch(gpu, 8);
    check_switch(gpu, 16);
}

TEST_GPU(a_stack_tells_until_an_update_over_frames_is_shown)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct world_light *light = room_open(&s, &run, gpu, 5);
    free(next_frame(&s));
    CHECK(!gi_is_updating(run.gi));
    light->position.x = 0.7f;
    float *last = next_frame(&s);
    int frames = 1;
    for (; frames < 9 && gi_is_updating(run.gi); frames++) {
        free(last);
        last = next_frame(&s);
    }
    if (frames < 2 || frames > 5) fail_msg("an update of 5 frames ends after %d", frames);
    for (int i = 0; i < 5; i++) {
        float *next = next_frame(&s);
        CHECK(change_of(&s, last, next) == 0.0 && !gi_is_updating(run.gi));
        free(next);
    }
    free(last);
    baked_fixture_close(&run, &s);
}

// Light that changes while an update runs is that of a later update.
TEST_GPU(an_update_over_frames_ends_with_the_light_of_one_frame)
{
    struct frame_fixture s[2];
    struct baked_fixture run[2];
    float *e[2];
    for (int k = 0; k < 2; k++) {
        const int frames = k == 0 ? 1 : 5;
        struct world_light *light = room_open(&s[k], &run[k], gpu, frames);
        free(next_frame(&s[k]));
        light->position.x = 0.7f;
        free(next_frame(&s[k]));
        light->position.x = -0.9f;
        for (int i = 0; i < 2 * frames; i++) free(next_frame(&s[k]));
        e[k] = next_frame(&s[k]);
    }
    assert_memory_equal(e[0], e[1], value_count(&s[0]) * sizeof *e[0]);
    for (int k = 1; k >= 0; k--) {
        free(e[k]);
        baked_fixture_close(&run[k], &s[k]);
    }
}

enum { STEPS = 12 };

// A light moves there and back: each frame has the light of its position alone.
TEST_GPU(a_light_that_moves_changes_light_by_its_own_change)
{
    struct frame_fixture s;
    struct baked_fixture run;
    struct world_light *light = room_open(&s, &run, gpu, 1);
    float *there[STEPS + 1];
    double largest = 0.0;
    for (int i = 0; i <= STEPS; i++) {
        light->position.x = -1.2f + 2.4f * (float)i / STEPS;
        there[i] = next_frame(&s);
        if (i > 0) largest = fmax(largest, change_of(&s, there[i - 1], there[i]));
    }
    for (int i = STEPS; i >= 0; i--) {
        light->position.x = -1.2f + 2.4f * (float)i / STEPS;
        float *back = next_frame(&s);
        assert_memory_equal(back, there[i], value_count(&s) * sizeof *back);
        free(back);
    }
    const double all = change_of(&s, there[0], there[STEPS]);
    print_message("largest change of a frame %.4f lux, from end to end %.4f, mean light %.4f\n",
                  largest, all, mean_of(&s, there[0]));
    CHECK(largest < all / 3);
    for (int i = 0; i <= STEPS; i++) free(there[i]);
    baked_fixture_close(&run, &s);
}
