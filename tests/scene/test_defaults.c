// Default camera and sun of scenes without.
#include "framework/test.h"

#include "scene/builtin/shapes.h"
#include "scene/builtin/builtin.h"
#include "scene/dark.h"
#include "scene/view/defaults.h"
#include "scene/scene_edit.h"
#include "scene/view/raycast.h"

#include <math.h>
#include <string.h>

// A scene of one shape, and its pose.
struct shape_fixture {
    struct scene *scene;
    struct scene_pose pose;
    struct shape_builder builder;
};

static void begin(struct shape_fixture *fixture)
{
    fixture->scene = scene_create(test_host(), "test");
    CHECK(fixture->scene);
    shape_begin(&fixture->builder, fixture->scene);
}

static void end(struct shape_fixture *fixture)
{
    CHECK(shape_emit(&fixture->builder, "shape", -1) >= 0);
    CHECK(pose_init(&fixture->pose, fixture->scene, -1, 0));
}

static void finish(struct shape_fixture *fixture)
{
    pose_finish(&fixture->pose);
    scene_destroy(fixture->scene);
}

// A room of 10 × 4 × 6 with walls 0.1 thick, times `scale`; an open roof has a hole in its middle.
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

static void make_room(struct shape_fixture *fixture, float scale, bool open_roof)
{
    struct room room = { open_roof };
    float x[6] = { -5.1f, -5, -4, 4, 5, 5.1f }, z[6] = { -3.1f, -3, -2, 2, 3, 3.1f };
    float y[4] = { -0.1f, 0, 4, 4.1f };
    begin(fixture);
    fixture->builder.scene_from_shape = glms_scale_make(vec3_of(scale, scale, scale));
    struct shape_grid grid = { x, y, z, 5, 3, 5, room_part, &room };
    shape_blocks(&fixture->builder, &grid, 1);
    end(fixture);
}

static void make_sphere(struct shape_fixture *fixture, float radius)
{
    begin(fixture);
    shape_sphere(&fixture->builder, vec3_of(3 * radius, 0, radius), radius, 48);
    end(fixture);
}

TEST(the_camera_of_a_room_is_inside_and_faces_along_its_length)
{
    static const float scales[3] = { 0.01f, 1, 100 };
    for (int i = 0; i < 3; i++) {
        struct shape_fixture fixture;
        float scale = scales[i];
        make_room(&fixture, scale, false);
        struct world_camera camera = default_camera(&fixture.pose);
        CHECK(fabsf(camera.eye.x) < 5 * scale && fabsf(camera.eye.z) < 3 * scale);
        CHECK(camera.eye.y > 0.2f * scale && camera.eye.y < 3 * scale);
        struct raycast raycast;
        struct raycast_hit hit;
        CHECK(raycast_init(&raycast, test_host(), &fixture.pose));
        CHECK(raycast_closest(&raycast, camera.eye, camera.forward, INFINITY, &hit));
        CHECK(hit.distance > 7 * scale);
        CHECK(camera.near_m > 0 && camera.near_m < 0.01f * scale);
        raycast_finish(&raycast);
        finish(&fixture);
    }
}

TEST(the_camera_of_a_room_in_metres_is_at_eye_level)
{
    struct shape_fixture fixture;
    make_room(&fixture, 1, false);
    CHECK_NEAR(default_camera(&fixture.pose).eye.y, 1.7, 1e-4);
    finish(&fixture);
}

// Whether all corners of the bounds are in an image of this aspect ratio, beyond the near plane.
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

TEST(the_camera_of_an_object_is_outside_and_sees_all_of_it)
{
    static const float radii[3] = { 0.07f, 1, 300 };
    for (int i = 0; i < 3; i++) {
        struct shape_fixture fixture;
        make_sphere(&fixture, radii[i]);
        struct world_camera camera = default_camera(&fixture.pose);
        vec3s centre = box3_centre(fixture.pose.bounds);
        CHECK(glms_vec3_distance(camera.eye, centre) > 1.5f * radii[i]);
        float fill;
        CHECK(frames(&camera, fixture.pose.bounds, 1, &fill));
        CHECK(fill > 0.7f); // and the object fills most of the image
        finish(&fixture);
    }
}

// Walls of a room of 4 × 4 × 4, of which some are missing: bits 1 to 8 are -x, +x, -z, +z.
static int stage_part(const void *user, int i, int j, int k)
{
    const int missing = *(const int *)user;
    if (j != 1) return 1;
    if (i == 0) return !(missing & 1);
    if (i == 2) return !(missing & 2);
    if (k == 0) return !(missing & 4);
    return k == 2 && !(missing & 8);
}

static struct world_camera camera_of_stage(int missing, struct box3 *bounds)
{
    struct shape_fixture fixture;
    float x[4] = { -2.1f, -2, 2, 2.1f }, y[4] = { -0.1f, 0, 4, 4.1f };
    struct shape_grid grid = { x, y, x, 3, 3, 3, stage_part, &missing };
    begin(&fixture);
    shape_blocks(&fixture.builder, &grid, 1);
    end(&fixture);
    struct world_camera camera = default_camera(&fixture.pose);
    *bounds = fixture.pose.bounds;
    finish(&fixture);
    return camera;
}

TEST(a_room_with_one_open_side_is_seen_whole_through_it)
{
    for (int side = 0; side < 4; side++) {
        struct box3 bounds;
        float fill;
        struct world_camera camera = camera_of_stage(1 << side, &bounds);
        CHECK(frames(&camera, bounds, 1, &fill) && fill > 0.9f);
        CHECK_NEAR(camera.forward.raw[side & 2], side & 1 ? -1 : 1, 1e-5);
    }
}

TEST(a_passage_with_two_open_ends_is_seen_from_inside)
{
    struct box3 bounds;
    struct world_camera camera = camera_of_stage(1 | 2, &bounds);
    CHECK(fabsf(camera.eye.x) < 2 && fabsf(camera.eye.z) < 2);
}

TEST(an_empty_scene_has_a_camera)
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

TEST(the_sun_reaches_the_interior_through_an_open_roof)
{
    struct shape_fixture fixture;
    make_room(&fixture, 1, true);
    struct default_lighting light = default_lighting(&fixture.pose);
    CHECK_NEAR(glms_vec3_norm(light.sun_direction), 1, 1e-5);
    double elevation = asin(-(double)light.sun_direction.y) * 180 / GLM_PI;
    CHECK(elevation > 34.9 && elevation < 75.1);
    // Part of the floor and part of a wall is lit.
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &fixture.pose));
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
    finish(&fixture);
}

TEST(the_sun_lights_surfaces_visible_to_the_outside_camera)
{
    struct shape_fixture fixture;
    make_sphere(&fixture, 1);
    struct world_camera camera = default_camera(&fixture.pose);
    struct default_lighting light = default_lighting(&fixture.pose);
    CHECK(glms_vec3_dot(light.sun_direction, camera.forward) > 0.3f);
    CHECK(light.sun_direction.y < -0.3f);
    CHECK_NEAR(light.sun_lux.x, 100000, 1);
    CHECK(light.sky.z > light.sky.x && luminance(light.sky) < 0.01f * luminance(light.sun_lux));
    finish(&fixture);
}

static void add_sun(struct shape_fixture *fixture, vec3s direction)
{
    int node = scene_add_node_looking(fixture->scene, "sun", vec3_of(0, 0, 0), direction);
    struct light sun = { .name = "sun", .type = LIGHT_SUN, .node = node };
    sun.intensity = vec3_of(1000, 1000, 1000);
    CHECK(node >= 0 && scene_add_light(fixture->scene, &sun) >= 0);
    pose_finish(&fixture->pose);
    CHECK(pose_init(&fixture->pose, fixture->scene, -1, 0));
}

TEST(the_camera_of_an_object_is_on_its_lit_side)
{
    for (int side = -1; side <= 1; side += 2) {
        struct shape_fixture fixture;
        make_sphere(&fixture, 1);
        add_sun(&fixture, vec3_of(0, -0.1f, -(float)side)); // the side lit is ±z
        CHECK((float)side * -default_camera(&fixture.pose).forward.z > 0.3f);
        finish(&fixture);
    }
}

TEST(the_camera_of_a_room_sees_its_direct_light)
{
    // The sun is low and reaches the wall at ±x through the hole in the roof, or the floor below
    // it.
    for (int side = -1; side <= 1; side += 2) {
        struct shape_fixture fixture;
        make_room(&fixture, 1, true);
        add_sun(&fixture, vec3_of((float)side * 0.9f, -0.7f, 0));
        struct world_camera camera = default_camera(&fixture.pose);
        CHECK(camera.forward.x * (float)side > 0.5f);
        finish(&fixture);
    }
}

TEST(defaults_are_deterministic)
{
    struct scene *scene = builtin_load(test_host(), "@atrium:texels=16");
    struct scene_pose pose;
    CHECK(scene && pose_init(&pose, scene, -1, 0));
    struct world_camera first = default_camera(&pose), second = default_camera(&pose);
    CHECK(memcmp(&first, &second, sizeof first) == 0);
    struct default_lighting a = default_lighting(&pose), b = default_lighting(&pose);
    CHECK(memcmp(&a, &b, sizeof a) == 0);
    // Inside the courtyard, facing along it.
    CHECK(fabsf(first.eye.z) < 3.5f && fabsf(first.forward.x) > 0.9f);
    pose_finish(&pose);
    scene_destroy(scene);
}

// Whether a scene is dark in its rest pose.
static bool is_dark(const struct scene *scene)
{
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    bool dark = pose_is_dark(&pose);
    pose_finish(&pose);
    return dark;
}

TEST(a_scene_is_dark_without_lights_emission_and_sky)
{
    struct scene *lit = builtin_load(test_host(), "@cornell:light=point");
    struct scene *emissive = builtin_load(test_host(), "@cornell");
    CHECK(lit && emissive && !is_dark(lit) && !is_dark(emissive));
    scene_remove_lights(lit);
    CHECK(is_dark(lit));
    lit->environment.sky = vec3_of(1, 1, 1);
    CHECK(!is_dark(lit));
    scene_destroy(lit);
    scene_destroy(emissive);
}

// Two spheres, of which the second emits and has `share` of the area.
static bool emission_leaves_dark(float cd_per_m2, float share)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct shape_builder builder;
    CHECK(scene);
    shape_begin(&builder, scene);
    shape_sphere(&builder, vec3_of(0, 0, 0), sqrtf(1 - share), 24);
    CHECK(shape_emit(&builder, "dark", -1) >= 0);
    struct material emitter = material_default();
    emitter.emissive = vec3_of(cd_per_m2, cd_per_m2, cd_per_m2);
    int material = scene_add_material(scene, &emitter);
    CHECK(material >= 0);
    shape_begin(&builder, scene);
    shape_sphere(&builder, vec3_of(4, 0, 0), sqrtf(share), 24);
    CHECK(shape_emit(&builder, "emitter", material) >= 0);
    bool dark = is_dark(scene);
    scene_destroy(scene);
    return dark;
}

TEST(emission_below_moonlight_leaves_a_scene_dark)
{
    // π · 1 cd/m² · 0.25 lx/π of the area is 0.25 lx.
    CHECK(emission_leaves_dark(1, 0.07f));
    CHECK(!emission_leaves_dark(1, 0.09f));
    CHECK(emission_leaves_dark(0.07f, 1 - 1e-6f) && !emission_leaves_dark(0.09f, 1 - 1e-6f));
    CHECK(!emission_leaves_dark(100, 1e-4f)); // a lamp, however small
}

static double volume(vec3s a, vec3s b, vec3s c)
{
    double ax = (double)a.x, ay = (double)a.y, az = (double)a.z;
    double bx = (double)b.x, by = (double)b.y, bz = (double)b.z;
    double cx = (double)c.x, cy = (double)c.y, cz = (double)c.z;
    return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}

// Distance along a ray to a triangle by signed volumes, INFINITY for a miss.
static double distance_to(vec3s origin, vec3s direction, vec3s a, vec3s b, vec3s c)
{
    a = glms_vec3_sub(a, origin);
    b = glms_vec3_sub(b, origin);
    c = glms_vec3_sub(c, origin);
    double u = volume(direction, b, c), v = volume(direction, c, a), w = volume(direction, a, b);
    if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) || u + v + w == 0) {
        return HUGE_VAL;
    }
    double distance = volume(a, b, c) / (u + v + w);
    return distance > 0 ? distance : HUGE_VAL;
}

static double nearest_of_all(const struct mesh *mesh, vec3s origin, vec3s direction)
{
    double nearest = HUGE_VAL;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const uint32_t *t = mesh->indices + i;
        nearest = fmin(nearest, distance_to(origin, direction, mesh->positions[t[0]],
                                            mesh->positions[t[1]], mesh->positions[t[2]]));
    }
    return nearest;
}

TEST(ray_hits_equal_brute_force)
{
    struct shape_fixture fixture;
    begin(&fixture);
    for (int i = 0; i < 5; i++) {
        vec3s centre = vec3_of((float)i, 0.3f * (float)i, -(float)(i % 2));
        shape_sphere(&fixture.builder, centre, 0.4f, 16);
    }
    end(&fixture);
    struct raycast raycast;
    CHECK(raycast_init(&raycast, test_host(), &fixture.pose));
    int hits = 0, differ = 0;
    for (int i = 0; i < 1000; i++) {
        float angle = 0.00625f * (float)i;
        vec3s origin = vec3_of(2 + 6 * cosf(angle), 0.6f, 6 * sinf(angle));
        vec3s aim = vec3_of(0.0055f * (float)i, 0.0015f * (float)i, -0.5f);
        vec3s direction = glms_vec3_normalize(glms_vec3_sub(aim, origin));
        double nearest = nearest_of_all(&fixture.scene->meshes[0], origin, direction);
        struct raycast_hit hit = { .distance = INFINITY };
        bool found = raycast_closest(&raycast, origin, direction, INFINITY, &hit);
        CHECK(raycast_blocked(&raycast, origin, direction, INFINITY) == found);
        hits += found;
        bool same = found ? fabs((double)hit.distance - nearest) < 1e-4 : nearest == HUGE_VAL;
        differ += !same;
        if (!found) continue;
        CHECK(hit.front && glms_vec3_dot(hit.normal, direction) < 0);
        CHECK(!raycast_blocked(&raycast, origin, direction, 0.999f * hit.distance));
    }
    CHECK(hits > 200 && hits < 1000 && differ == 0);
    raycast_finish(&raycast);
    finish(&fixture);
}

TEST(the_camera_of_sponza_is_inside_and_the_sun_lights_the_floor)
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
