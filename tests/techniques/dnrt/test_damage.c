// Damaged bakes of dnrt: bounds that no geometry within the limits of a scene has are refused.
#include "techniques/damage_fixture.h"
#include "techniques/dnrt/sphere_fixture.h"

#include <string.h>

enum { SCALE = 2 }; // of the mesh of radius 1

// A floor and a ball, which a narrow view has at its right.
static void open_ball(struct damage_fixture *u, struct gpu *gpu)
{
    struct frame_fixture *s = &u->s;
    struct node node = node_default();
    node.translation = vec3_of(30000, 2, 0);
    node.scale = vec3_of(SCALE, SCALE, SCALE);
    *u = (struct damage_fixture){ .term = 1 };
    fixture_init(s, gpu);
    fixture_floor(s, 3, fixture_matte(s, vec3_of(0.7f, 0.7f, 0.7f)));
    const int mesh = sphere_fixture_add(s->scene, fixture_matte(s, vec3_of(0.2f, 0.4f, 0.9f)));
    s->scene->instances[fixture_instance(s, mesh, &node)].movable = true;
    fixture_look(s, vec3_of(0, 2, 4), vec3_of(0, 0, 0));
    s->input.camera.vertical_fov_rad = 1.7453e-5f;
    damage_open(u, "lpv:geometry=off,dim=16,cascades=1+dnrt:size=16,rays=16", 1);
}

static bool loads_with(struct damage_fixture *u, const char *tensor, int element, float value)
{
    const size_t i = damage_index(u, baked_tensor(u->from, tensor)->name);
    ((float *)damage_own(u, i))[element] = value;
    const bool loads = damage_loads(u);
    damage_restore(u, i);
    return loads;
}

TEST_GPU(a_sphere_or_box_beyond_the_limits_of_a_scene_is_refused)
{
    static const float BEYOND[] = { 1e9f, 1e20f, 3e38f }; // twice that in the world
    struct damage_fixture u;
    open_ball(&u, gpu);
    CHECK(damage_loads(&u));
    for (size_t i = 0; i < sizeof BEYOND / sizeof *BEYOND; i++) {
        for (int k = 0; k < 4; k++)
            CHECK(!loads_with(&u, "sphere", k, BEYOND[i]) &&
                  strstr(test_last_message(), "shape 0: its bounds reach beyond"));
        for (int k = 0; k < 6; k++)
            CHECK(!loads_with(&u, "box", k, BEYOND[i]) &&
                  strstr(test_last_message(), "shape 0: its bounds reach beyond"));
    }
    damage_close(&u);
}

TEST_GPU(a_sphere_or_box_of_negative_size_is_refused)
{
    struct damage_fixture u;
    open_ball(&u, gpu);
    CHECK(!loads_with(&u, "sphere", 3, -1) &&
          strstr(test_last_message(), "shape 0: its radius is negative"));
    for (int k = 3; k < 6; k++)
        CHECK(!loads_with(&u, "box", k, -1) &&
              strstr(test_last_message(), "shape 0: its box has a negative edge"));
    damage_close(&u);
}

// The whole range of bounds that are accepted, seen far beside a narrow view.
TEST_GPU(a_sphere_within_the_limits_of_a_scene_is_rendered)
{
    struct damage_fixture u;
    open_ball(&u, gpu);
    for (float size = 1e-30f; size < 1e8f; size *= 1000)
        for (int k = 0; k < 4; k++) CHECK(loads_with(&u, "sphere", k, size));
    damage_close(&u);
}
