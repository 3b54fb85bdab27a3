// The camera and the sun of scenes that bring none.
#include "framework/test.h"

#include "scene/builtin/shapes.h"
#include "scene/builtin/builtin.h"
#include "scene/defaults.h"
#include "scene/raycast.h"

#include <math.h>
#include <string.h>

// A scene made of one shape, and its pose.
struct staged {
    struct scene *scene;
    struct scene_pose pose;
    struct shape_builder builder;
};

static void begin(struct staged *staged)
{
    staged->scene = scene_create(test_host(), "test");
    CHECK(staged->scene);
    shape_begin(&staged->builder, staged->scene);
}

static void end(struct staged *staged)
{
    CHECK(shape_emit(&staged->builder, "shape", -1) >= 0);
    CHECK(pose_init(&staged->pose, staged->scene, -1, 0));
}

static void finish(struct staged *staged)
{
    pose_finish(&staged->pose);
    scene_destroy(staged->scene);
}

// Walls 0.1 thick around a room of 10 × 4 × 6, times `scale`; an open roof lacks its middle.
struct room {
    bool open_roof;
};

static int room_part(const void *user, int i, int j, int k)
{
    const struct room *room = user;
    bool inside = i > 0 && i < 4 && k > 0 && k < 4;
    if (j == 0) return 1;
    if (j == 2) return !(room->open_roof && i == 2 && k == 2);
    return !inside;
}

static void stage_room(struct staged *staged, float scale, bool open_roof)
{
    struct room room = { open_roof };
    float x[6] = { -5.1f, -5, -4, 4, 5, 5.1f }, z[6] = { -3.1f, -3, -2, 2, 3, 3.1f };
    float y[4] = { -0.1f, 0, 4, 4.1f };
    begin(staged);
    staged->builder.scene_from_shape = glms_scale_make(vec3_of(scale, scale, scale));
    struct shape_grid grid = { x, y, z, 5, 3, 5, room_part, &room };
    shape_blocks(&staged->builder, &grid, 1);
    end(staged);
}

static void stage_sphere(struct staged *staged, float radius)
{
    begin(staged);
    shape_sphere(&staged->builder, vec3_of(3 * radius, 0, radius), radius, 48);
    end(staged);
}

TEST(a_room_is_seen_from_inside_along_its_length)
{
    static const float scales[3] = { 0.01f, 1, 100 };
    for (int i = 0; i < 3; i++) {
        struct staged staged;
        float scale = scales[i];
        stage_room(&staged, scale, false);
        struct world_camera camera = default_camera(&staged.pose);
        CHECK(fabsf(camera.eye.x) < 5 * scale && fabsf(camera.eye.z) < 3 * scale);
        CHECK(camera.eye.y > 0.2f * scale && camera.eye.y < 3 * scale);
        struct raycast raycast;
        struct raycast_hit hit;
        CHECK(raycast_init(&raycast, test_host(), &staged.pose));
        CHECK(raycast_closest(&raycast, camera.eye, camera.forward, INFINITY, &hit));
        CHECK(hit.distance > 7 * scale);
        CHECK(camera.near_m > 0 && camera.near_m < 0.01f * scale);
        raycast_finish(&raycast);
        finish(&staged);
    }
}

TEST(a_person_stands_at_a_persons_height)
{
    struct staged staged;
    stage_room(&staged, 1, false);
    CHECK_NEAR(default_camera(&staged.pose).eye.y, 1.7, 1e-4);
    finish(&staged);
}

// Whether all corners of the bounds lie in a picture of this aspect ratio, before the near plane.
static bool frames(const struct world_camera *camera, struct box3 bounds, float aspect, float *fill)
{
    vec3s right = glms_vec3_cross(camera->forward, camera->up);
    float tangent = tanf(0.5f * camera->vertical_fov_rad);
    *fill = 0;
    for (int i = 0; i < 8; i++) {
        vec3s corner =
            vec3_of(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                    i & 4 ? bounds.max.z : bounds.min.z);
        vec3s offset = glms_vec3_sub(corner, camera->eye);
        float depth = glms_vec3_dot(offset, camera->forward);
        if (depth < camera->near_m) return false;
        float x = glms_vec3_dot(offset, right) / (depth * tangent * aspect);
        float y = glms_vec3_dot(offset, camera->up) / (depth * tangent);
        *fill = fmaxf(*fill, fmaxf(fabsf(x), fabsf(y)));
    }
    return *fill <= 1;
}

TEST(a_thing_is_seen_from_outside_and_whole)
{
    static const float radii[3] = { 0.07f, 1, 300 };
    for (int i = 0; i < 3; i++) {
        struct staged staged;
        stage_sphere(&staged, radii[i]);
        struct world_camera camera = default_camera(&staged.pose);
        vec3s centre = box3_centre(staged.pose.bounds);
        CHECK(glms_vec3_distance(camera.eye, centre) > 1.5f * radii[i]);
        float fill;
        CHECK(frames(&camera, staged.pose.bounds, 1, &fill));
        CHECK(fill > 0.7f); // and not lost in the distance
        finish(&staged);
    }
}

TEST(an_empty_scene_has_a_camera_too)
{
    struct scene *scene = scene_create(test_host(), "empty");
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    struct world_camera camera = default_camera(&pose);
    CHECK_NEAR(glms_vec3_norm(camera.forward), 1, 1e-5);
    CHECK(camera.near_m > 0 && isfinite(camera.eye.z));
    CHECK_NEAR(glms_vec3_norm(default_lighting(&pose).sun_direction), 1, 1e-5);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(the_sun_reaches_the_inside_through_an_open_roof)
{
    struct staged staged;
    stage_room(&staged, 1, true);
    struct default_lighting light = default_lighting(&staged.pose);
    CHECK_NEAR(glms_vec3_norm(light.sun_direction), 1, 1e-5);
    double elevation = asin(-(double)light.sun_direction.y) * 180 / GLM_PI;
    CHECK(elevation > 34.9 && elevation < 75.1);
    // Some of the floor is lit, and some of a wall.
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &staged.pose));
    int floor = 0, wall = 0;
    vec3s towards = glms_vec3_negate(light.sun_direction);
    for (int i = 0; i < 400; i++) {
        float u = (float)(i % 20) / 20 + 0.02f, v = (float)(i / 20) / 20 + 0.02f;
        vec3s on_floor = vec3_of(-4.9f + 9.8f * u, 0.001f, -2.9f + 5.8f * v);
        floor += !raycast_blocked(&raycast, on_floor, towards, INFINITY);
        for (int side = -1; side <= 1; side += 2) {
            vec3s on_long = vec3_of(-4.9f + 9.8f * u, 3.9f * v, 2.999f * (float)side);
            vec3s on_short = vec3_of(4.999f * (float)side, 3.9f * v, -2.9f + 5.8f * u);
            wall += !raycast_blocked(&raycast, on_long, towards, INFINITY);
            wall += !raycast_blocked(&raycast, on_short, towards, INFINITY);
        }
    }
    CHECK(floor > 20 && wall > 20);
    raycast_finish(&raycast);
    finish(&staged);
}

TEST(the_sun_lights_what_the_outside_camera_sees)
{
    struct staged staged;
    stage_sphere(&staged, 1);
    struct world_camera camera = default_camera(&staged.pose);
    struct default_lighting light = default_lighting(&staged.pose);
    CHECK(glms_vec3_dot(light.sun_direction, camera.forward) > 0.3f);
    CHECK(light.sun_direction.y < -0.3f);
    CHECK_NEAR(light.sun_lux.x, 100000, 1);
    CHECK(light.sky.z > light.sky.x && luminance(light.sky) < 0.01f * luminance(light.sun_lux));
    finish(&staged);
}

TEST(defaults_are_the_same_every_time)
{
    struct scene *scene = builtin_load(test_host(), "@atrium:texels=16");
    struct scene_pose pose;
    CHECK(scene && pose_init(&pose, scene, -1, 0));
    struct world_camera first = default_camera(&pose), second = default_camera(&pose);
    CHECK(memcmp(&first, &second, sizeof first) == 0);
    struct default_lighting a = default_lighting(&pose), b = default_lighting(&pose);
    CHECK(memcmp(&a, &b, sizeof a) == 0);
    // Inside the court, looking along it.
    CHECK(fabsf(first.eye.z) < 3.5f && fabsf(first.forward.x) > 0.9f);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(a_scene_is_dark_without_lights_emission_and_sky)
{
    struct scene *lit = builtin_load(test_host(), "@cornell:light=point");
    struct scene *shining = builtin_load(test_host(), "@cornell");
    CHECK(lit && shining && !scene_is_dark(lit) && !scene_is_dark(shining));
    scene_remove_lights(lit);
    CHECK(scene_is_dark(lit));
    lit->sky = vec3_of(1, 1, 1);
    CHECK(!scene_is_dark(lit));
    scene_destroy(lit);
    scene_destroy(shining);
}

static double volume(vec3s a, vec3s b, vec3s c)
{
    double ax = (double)a.x, ay = (double)a.y, az = (double)a.z;
    double bx = (double)b.x, by = (double)b.y, bz = (double)b.z;
    double cx = (double)c.x, cy = (double)c.y, cz = (double)c.z;
    return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}

// Distance along a ray to a triangle by signed volumes, INFINITY for a miss.
static double distance_to(vec3s eye, vec3s direction, vec3s a, vec3s b, vec3s c)
{
    a = glms_vec3_sub(a, eye);
    b = glms_vec3_sub(b, eye);
    c = glms_vec3_sub(c, eye);
    double u = volume(direction, b, c), v = volume(direction, c, a), w = volume(direction, a, b);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) {
        return HUGE_VAL;
    }
    double distance = volume(a, b, c) / (u + v + w);
    return distance > 0 ? distance : HUGE_VAL;
}

static double nearest_of_all(const struct mesh *mesh, vec3s eye, vec3s direction)
{
    double nearest = HUGE_VAL;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *t = mesh->indices + i;
        nearest = fmin(nearest, distance_to(eye, direction, mesh->positions[t[0]],
                                            mesh->positions[t[1]], mesh->positions[t[2]]));
    }
    return nearest;
}

TEST(rays_meet_what_brute_force_meets)
{
    struct staged staged;
    begin(&staged);
    for (int i = 0; i < 5; i++) {
        vec3s centre = vec3_of((float)i, 0.3f * (float)i, -(float)(i % 2));
        shape_sphere(&staged.builder, centre, 0.4f, 16);
    }
    end(&staged);
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &staged.pose));
    int met = 0, differ = 0;
    for (int i = 0; i < 1000; i++) {
        float turn = 0.00625f * (float)i;
        vec3s eye = vec3_of(2 + 6 * cosf(turn), 0.6f, 6 * sinf(turn));
        vec3s aim = vec3_of(0.0055f * (float)i, 0.0015f * (float)i, -0.5f);
        vec3s direction = glms_vec3_normalize(glms_vec3_sub(aim, eye));
        double nearest = nearest_of_all(&staged.scene->meshes[0], eye, direction);
        struct raycast_hit hit = { .distance = INFINITY };
        bool found = raycast_closest(&raycast, eye, direction, INFINITY, &hit);
        CHECK(raycast_blocked(&raycast, eye, direction, INFINITY) == found);
        met += found;
        bool same = found ? fabs((double)hit.distance - nearest) < 1e-4 : nearest == HUGE_VAL;
        differ += !same;
        if (!found) continue;
        CHECK(hit.front && glms_vec3_dot(hit.normal, direction) < 0);
        CHECK(!raycast_blocked(&raycast, eye, direction, 0.999f * hit.distance));
    }
    CHECK(met > 200 && met < 1000 && differ == 0);
    raycast_finish(&raycast);
    finish(&staged);
}

TEST(sponza_is_seen_from_inside_with_floor_in_the_sun)
{
    struct scene *scene = scene_load(test_host(), test_scene_path("sponza.glb"));
    struct scene_pose pose;
    CHECK(scene && pose_init(&pose, scene, -1, 0));
    struct world_camera camera = default_camera(&pose);
    CHECK(fabsf(camera.eye.z) < 3 && fabsf(camera.forward.x) > 0.9f);
    CHECK(camera.eye.y > 0.5f && camera.eye.y < 3);
    struct default_lighting light = default_lighting(&pose);
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &pose));
    int lit = 0;
    for (int i = 0; i < 100; i++) {
        vec3s on_floor = vec3_of(-8 + 0.16f * (float)i, 0.05f, -2 + 0.35f * (float)(i % 12));
        lit +=
            !raycast_blocked(&raycast, on_floor, glms_vec3_negate(light.sun_direction), INFINITY);
    }
    CHECK(lit > 10);
    raycast_finish(&raycast);
    pose_finish(&pose);
    scene_destroy(scene);
}
