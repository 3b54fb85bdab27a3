// The camera's path: it meets its keys, takes the shorter way around, and is straight where they
// are.
#include "viewer/camera/path.h"

#include "framework/test.h"

#include <math.h>

static const float PI = 3.14159265f;

static void add(struct path *path, float x, float yaw)
{
    const struct look look = { .eye = { x, 2.0f * x, 1.0f }, .yaw = yaw, .fov_deg = 40.0f + x };
    CHECK(path_add(path, &look));
}

TEST(a_path_meets_its_keys)
{
    struct path path = { .seconds = 2.0f, .fps = 5 };
    struct look look = { .distance = 3.0f };
    CHECK(path_frames(&path) == 0);
    for (int i = 0; i < 4; i++) add(&path, (float)(i * i), 0.3f * (float)i);
    CHECK(path_frames(&path) == 31);
    for (int i = 0; i < 4; i++) {
        path_at(&path, 10 * i, &look);
        CHECK_NEAR(look.eye[0], i * i, 1e-5);
        CHECK_NEAR(look.eye[1], 2 * i * i, 1e-5);
        CHECK_NEAR(look.yaw, 0.3 * i, 1e-5);
        CHECK_NEAR(look.fov_deg, 40 + i * i, 1e-4);
        CHECK_NEAR(look.distance, 3, 0);
    }
    path_at(&path, 1000, &look);
    CHECK_NEAR(look.eye[0], 9, 1e-5);
}

TEST(a_path_through_equal_steps_is_even)
{
    struct path path = { .seconds = 1.0f, .fps = 10 };
    struct look look = { 0 };
    for (int i = 0; i < 5; i++) add(&path, (float)i, 0.0f);
    for (int frame = 10; frame <= 30; frame++) {
        path_at(&path, frame, &look);
        CHECK_NEAR(look.eye[0], 0.1 * frame, 1e-5);
    }
}

TEST(a_path_turns_the_shorter_way)
{
    struct path path = { .seconds = 1.0f, .fps = 10 };
    struct look look = { 0 };
    add(&path, 0, 0.9f * PI);
    add(&path, 1, -0.9f * PI);
    for (int frame = 0; frame <= 10; frame++) {
        path_at(&path, frame, &look);
        CHECK(fabsf(look.yaw) > 0.89f * PI);
    }
}

TEST(a_path_of_one_key_is_an_image)
{
    struct path path = { .seconds = 1.0f, .fps = 30 };
    struct look look = { 0 };
    add(&path, 3, 0.5f);
    CHECK(path_frames(&path) == 1);
    path_at(&path, 0, &look);
    CHECK_NEAR(look.eye[0], 3, 1e-6);
    path_remove(&path, 0);
    CHECK(path_frames(&path) == 0);
    for (int i = 0; i < PATH_KEYS; i++) add(&path, (float)i, 0.0f);
    CHECK(!path_add(&path, &look));
}
