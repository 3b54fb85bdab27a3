// A house on 40 m of ground, much more than the camera sees: the levels of the clip map that vct
// chooses give the room the light of the reference, and rays that go from level to level find
// closed walls closed.
#include "techniques/trials/light_trial.h"

#include <math.h>
#include <stdio.h>

static const vec3s LOW = { { -3, 0, -2.5f } }, HIGH = { { 3, 2.8f, 2.5f } }; // the room
static const float WALL = 0.2f;                                              // m
static const float SUN_LUX = 1000;

static void add_window_wall(struct frame_fixture *s, int white)
{
    const float z = HIGH.z, out = HIGH.z + WALL;
    fixture_box(s, vec3_of(LOW.x, 0, z), vec3_of(HIGH.x, 0.9f, out), false, white);
    fixture_box(s, vec3_of(LOW.x, 2.1f, z), vec3_of(HIGH.x, HIGH.y, out), false, white);
    fixture_box(s, vec3_of(LOW.x, 0.9f, z), vec3_of(-0.8f, 2.1f, out), false, white);
    fixture_box(s, vec3_of(0.8f, 0.9f, z), vec3_of(HIGH.x, 2.1f, out), false, white);
}

static void add_house(struct frame_fixture *s, bool window)
{
    const int white = fixture_matte(s, vec3_of(0.75f, 0.75f, 0.72f)),
              ground = fixture_matte(s, vec3_of(0.3f, 0.32f, 0.2f));
    const vec3s a = LOW, b = HIGH;
    const float t = WALL;
    fixture_box(s, vec3_of(-20, -0.4f, -20), vec3_of(20, -0.2f, 20), false, ground);
    fixture_box(s, vec3_of(a.x - t, -t, a.z - t), vec3_of(b.x + t, 0, b.z + t), false, white);
    fixture_box(s, vec3_of(a.x - t, b.y, a.z - t), vec3_of(b.x + t, b.y + t, b.z + t), false,
                white);
    fixture_box(s, vec3_of(a.x - t, 0, a.z - t), vec3_of(a.x, b.y, b.z + t), false, white);
    fixture_box(s, vec3_of(b.x, 0, a.z - t), vec3_of(b.x + t, b.y, b.z + t), false, white);
    fixture_box(s, vec3_of(a.x, 0, a.z - t), vec3_of(b.x, b.y, a.z), false, white);
    if (window)
        add_window_wall(s, white);
    else
        fixture_box(s, vec3_of(a.x, 0, b.z), vec3_of(b.x, b.y, b.z + t), false, white);
}

static void build(struct frame_fixture *s, struct gpu *gpu, bool window)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 2048;
    add_house(s, window);
    fixture_look(s, vec3_of(2.6f, 1.6f, 2.2f), vec3_of(-1.5f, 1.2f, -1.5f));
    fixture_add_sun(s, vec3_of(-0.3f, -0.7f, -0.8f), vec3_of(SUN_LUX, SUN_LUX, SUN_LUX));
    s->input.environment.sky = vec3_of(30, 37, 50);
}

static void build_with_window(struct frame_fixture *s, struct gpu *gpu)
{
    build(s, gpu, true);
}

// With one grid over the ground, voxels are 0.65 m or 1.4 m.
TEST_GPU(a_room_with_a_window_has_the_light_of_the_reference)
{
    const struct trial_bounds bounds[] = {
        { "vct:quality=low", 0.75, 1.25 },
        { "vct", 0.85, 1.15 },
    };
    for (int i = 0; i < 2; i++) {
        const struct trial_bounds *b = &bounds[i];
        const struct trial_error error = trial_error_of(gpu, build_with_window, b->gi, 512);
        print_message("%s: energy %.3f of the reference, FLIP %.3f\n", b->gi, error.energy,
                      error.flip);
        CHECK(error.energy > b->least && error.energy < b->most);
    }
}

TEST_GPU(a_closed_room_is_dark)
{
    static const char *const specs[] = { "vct:quality=low", "vct", "vct:resolution=32,levels=5",
                                         "vct:resolution=48,levels=2" };
    for (int i = 0; i < 4; i++) {
        struct frame_fixture s;
        build(&s, gpu, false);
        const struct trial_irradiance e = trial_technique(&s, specs[i]);
        fixture_finish(&s);
        print_message("%s: %.5f of the sun\n", specs[i], e.mean[1] / (double)SUN_LUX);
        CHECK(e.mean[1] <= 0.002 * (double)SUN_LUX);
    }
}
