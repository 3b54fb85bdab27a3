// The viewer's camera: rays and projections are inverse; orbits keep their point.
#include "viewer/camera/look.h"

#include "framework/test.h"

#include <math.h>

static const struct look looks[] = {
    { .eye = { 1, 2, 3 }, .yaw = 0.7f, .pitch = -0.4f, .fov_deg = 60, .distance = 4 },
    { .eye = { -5, 0, 0.5f }, .yaw = -2.9f, .pitch = 1.2f, .fov_deg = 25, .distance = 0.3f },
};

TEST(a_ray_projects_to_its_place)
{
    for (int k = 0; k < 2; k++)
        for (float x = -1; x <= 1; x += 0.25f) {
            const float at[2] = { x, 0.3f - 0.5f * x };
            float ray[3], point[3], back[2];
            look_ray(&looks[k], 1.6f, at, ray);
            for (int i = 0; i < 3; i++) point[i] = looks[k].eye[i] + 2.5f * ray[i];
            CHECK(look_project(&looks[k], 1.6f, point, back));
            CHECK_NEAR(back[0], at[0], 1e-4);
            CHECK_NEAR(back[1], at[1], 1e-4);
            CHECK_NEAR(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2], 1, 1e-5);
        }
}

TEST(the_middle_of_the_image_is_ahead)
{
    const float middle[2] = { 0, 0 };
    for (int k = 0; k < 2; k++) {
        float ray[3], forward[3];
        look_ray(&looks[k], 0.7f, middle, ray);
        look_forward(&looks[k], forward);
        for (int i = 0; i < 3; i++) CHECK_NEAR(ray[i], forward[i], 1e-6);
    }
}

TEST(an_orbit_keeps_its_point)
{
    for (int k = 0; k < 2; k++) {
        struct look look = looks[k];
        float before[3], after[3];
        look_target(&look, before);
        look_orbit(&look, 0.9f, 0.2f);
        look_target(&look, after);
        for (int i = 0; i < 3; i++) CHECK_NEAR(before[i], after[i], 1e-5);
        CHECK(fabsf(look.eye[0] - looks[k].eye[0]) > 0.01f);
    }
}
