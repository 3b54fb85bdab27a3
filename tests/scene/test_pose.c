// Poses: hierarchy, animation, skins, morph targets, bounds, lights, cameras.
#include "framework/test.h"

#include "scene/animation_sample.h"
#include "scene/pose.h"

#include <math.h>
#include <string.h>

static void check_vec3(vec3s a, vec3s b, double tolerance)
{
    CHECK_NEAR(a.x, b.x, tolerance);
    CHECK_NEAR(a.y, b.y, tolerance);
    CHECK_NEAR(a.z, b.z, tolerance);
}

static vec3s positions[3] = { { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 0, 2, 0 } } };
static vec3s normals[3] = { { { 0, 0, 1 } }, { { 0, 0, 1 } }, { { 0, 0, 1 } } };
static vec4s tangents[3] = { { { 1, 0, 0, 1 } }, { { 1, 0, 0, 1 } }, { { 1, 0, 0, -1 } } };
static uint32_t indices[3] = { 0, 1, 2 };

static struct mesh triangle(void)
{
    return (struct mesh){ .name = "triangle",
                          .vertex_count = 3,
                          .index_count = 3,
                          .positions = positions,
                          .normals = normals,
                          .tangents = tangents,
                          .indices = indices };
}

static versors rotation(float degrees, vec3s axis)
{
    return glms_quatv(glm_rad(degrees), axis);
}

// Node 0 is translated by (1, 2, 3) and rotated by 90 degrees around +y; node 1 is its child, at
// (0, 0, 1), scaled by 2.
static struct scene *parent_and_child(void)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct node node = node_default();
    node.translation = vec3_of(1, 2, 3);
    node.rotation = rotation(90, vec3_of(0, 1, 0));
    CHECK(scene_add_node(scene, &node) == 0);
    node = node_default();
    node.parent = 0;
    node.translation = vec3_of(0, 0, 1);
    node.scale = vec3_of(2, 2, 2);
    CHECK(scene_add_node(scene, &node) == 1);
    return scene;
}

static void add_triangle(struct scene *scene, int node)
{
    struct mesh mesh = triangle();
    struct instance instance = { .node = node, .mesh = scene_add_mesh(scene, &mesh), .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) >= 0);
}

TEST(a_child_follows_its_parent)
{
    struct scene *scene = parent_and_child();
    add_triangle(scene, 1);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    // The rotation maps (x, y, z) to (z, y, -x).
    vec3s moved = mat4_point(pose.world_from_node[1], vec3_of(1, 0, 0));
    check_vec3(moved, vec3_of(1 + 1, 2, 3 - 2), 1e-5);
    check_vec3(pose.bounds.min, vec3_of(2, 2, 1), 1e-5);
    check_vec3(pose.bounds.max, vec3_of(2, 6, 3), 1e-5);
    CHECK(!pose.deformed[0].positions);
    pose_finish(&pose);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(the_hash_of_surfaces_changes_with_instances_alone)
{
    struct scene *scene = parent_and_child();
    struct scene_pose pose;
    add_triangle(scene, 0); // node 1 has none
    CHECK(pose_init(&pose, scene, -1, 0));
    const uint64_t before = pose_surfaces_hash(&pose);
    scene->nodes[1].translation.x += 1;
    pose_update(&pose, -1, 0);
    CHECK(pose_surfaces_hash(&pose) == before);
    scene->nodes[0].translation.x += 1;
    pose_update(&pose, -1, 0);
    CHECK(pose_surfaces_hash(&pose) != before);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(a_matrix_replaces_translation_rotation_and_scale)
{
    struct scene *scene = parent_and_child();
    struct node node = node_default();
    node.has_matrix = true;
    node.matrix = glms_translate_make(vec3_of(5, 6, 7));
    CHECK(scene_add_node(scene, &node) == 2);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    check_vec3(vec3_xyz(pose.world_from_node[2].col[3]), vec3_of(5, 6, 7), 0);
    CHECK(box3_is_empty(pose.bounds));
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(bounds_are_tight_under_rotation)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct node node = node_default();
    node.rotation = rotation(45, vec3_of(0, 0, 1));
    CHECK(scene_add_node(scene, &node) == 0);
    add_triangle(scene, 0);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    float h = sqrtf(0.5f);
    check_vec3(pose.bounds.min, vec3_of(-2 * h, 0, 0), 1e-5);
    check_vec3(pose.bounds.max, vec3_of(h, 2 * h, 0), 1e-5);
    pose_finish(&pose);
    scene_destroy(scene);
}

static struct animation_channel channel(enum channel_path path,
                                        enum channel_interpolation interpolation, int width,
                                        int key_count, float *times, float *values)
{
    return (struct animation_channel){ 0, path, interpolation, key_count, width, times, values };
}

TEST(step_and_linear_channels_are_clamped_to_their_keys)
{
    float times[3] = { 1, 2, 4 }, values[9] = { 0, 0, 0, 10, 0, 0, 30, 0, 0 }, out[3];
    struct animation_channel c = channel(PATH_TRANSLATION, INTERPOLATE_LINEAR, 3, 3, times, values);
    const float at[7] = { -5, 1, 1.5f, 2, 3, 4, 9 }, linear[7] = { 0, 0, 5, 10, 20, 30, 30 };
    const float step[7] = { 0, 0, 0, 10, 10, 30, 30 };
    for (int i = 0; i < 7; i++) {
        c.interpolation = INTERPOLATE_LINEAR;
        channel_sample(&c, at[i], 3, out);
        CHECK_NEAR(out[0], linear[i], 1e-6);
        c.interpolation = INTERPOLATE_STEP;
        channel_sample(&c, at[i], 3, out);
        CHECK_NEAR(out[0], step[i], 1e-6);
    }
}

TEST(linear_rotation_has_a_constant_rate_along_the_shorter_arc)
{
    versors a = rotation(0, vec3_of(0, 1, 0)), b = rotation(120, vec3_of(0, 1, 0));
    for (int sign = -1; sign <= 1; sign += 2) {
        float times[2] = { 0, 3 }, values[8], out[4];
        memcpy(values, a.raw, sizeof a.raw);
        for (int i = 0; i < 4; i++) values[4 + i] = (float)sign * b.raw[i];
        struct animation_channel c =
            channel(PATH_ROTATION, INTERPOLATE_LINEAR, 4, 2, times, values);
        for (int second = 0; second <= 3; second++) {
            channel_sample(&c, (float)second, 4, out);
            versors expected = rotation(40.0f * (float)second, vec3_of(0, 1, 0));
            double dot = 0;
            for (int i = 0; i < 4; i++) dot += (double)out[i] * (double)expected.raw[i];
            CHECK_NEAR(fabs(dot), 1, 1e-6);
        }
    }
}

TEST(cubic_channels_interpolate_keys_and_tangents)
{
    // For each key: in-tangent, value, out-tangent.
    float times[2] = { 1, 3 }, values[6] = { 9, 2, -1, 4, 5, 9 }, out;
    struct animation_channel c = channel(PATH_WEIGHTS, INTERPOLATE_CUBIC, 1, 2, times, values);
    channel_sample(&c, 1, 1, &out);
    CHECK_NEAR(out, 2, 0);
    channel_sample(&c, 3, 1, &out);
    CHECK_NEAR(out, 5, 0);
    float h = 1.0f / 256, near_out, near_in;
    channel_sample(&c, 1 + h, 1, &near_out);
    channel_sample(&c, 3 - h, 1, &near_in);
    CHECK_NEAR((near_out - 2) / h, -1, 0.05);
    CHECK_NEAR((5 - near_in) / h, 4, 0.05);
    // The spline at its midpoint: (p0 + p1)/2 + d (m0 − m1)/8.
    channel_sample(&c, 2, 1, &out);
    CHECK_NEAR(out, 3.5 + 2.0 * (-1 - 4) / 8, 1e-6);
}

static void set_animation(struct scene *scene, struct animation *animation,
                          struct animation_channel *channels, int count, float duration_s)
{
    *animation = (struct animation){ "move", duration_s, channels, count };
    scene->animations = animation;
    scene->animation_count = 1;
}

TEST(time_wraps_around_the_duration)
{
    struct scene *scene = parent_and_child();
    float times[2] = { 0, 2 }, values[6] = { 0, 0, 0, 8, 0, 0 };
    struct animation_channel c = channel(PATH_TRANSLATION, INTERPOLATE_LINEAR, 3, 2, times, values);
    struct animation animation;
    set_animation(scene, &animation, &c, 1, 2);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, 0, 0.5f));
    CHECK_NEAR(pose.world_from_node[0].col[3].x, 2, 1e-6);
    pose_update(&pose, 0, 4.5f);
    CHECK_NEAR(pose.world_from_node[0].col[3].x, 2, 1e-5);
    pose_update(&pose, 0, -0.5f);
    CHECK_NEAR(pose.world_from_node[0].col[3].x, 6, 1e-5);
    pose_update(&pose, -1, 0.5f); // back to the rest pose
    check_vec3(vec3_xyz(pose.world_from_node[0].col[3]), vec3_of(1, 2, 3), 0);
    pose_finish(&pose);
    CHECK(!pose_init(&pose, scene, 1, 0));
    CHECK(!pose_init(&pose, scene, 0, NAN));
    scene->animation_count = 0;
    scene_destroy(scene);
}

TEST(rotation_keys_rotate_a_node_and_its_children)
{
    struct scene *scene = parent_and_child();
    float times[2] = { 0, 1 }, values[8];
    memcpy(values, rotation(0, vec3_of(0, 1, 0)).raw, 4 * sizeof(float));
    memcpy(values + 4, rotation(120, vec3_of(0, 1, 0)).raw, 4 * sizeof(float));
    struct animation_channel c = channel(PATH_ROTATION, INTERPOLATE_LINEAR, 4, 2, times, values);
    struct animation animation;
    set_animation(scene, &animation, &c, 1, 1);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, 0, 0.75f));
    check_vec3(vec3_xyz(pose.world_from_node[1].col[3]), vec3_of(2, 2, 3), 1e-5);
    pose_finish(&pose);
    scene->animation_count = 0;
    scene_destroy(scene);
}

// A triangle skinned to nodes 0 and 1 of `scene`.
struct skinned {
    int joints[2];
    mat4s joint_from_mesh[2];
    struct skin skin;
};

static void add_skinned(struct scene *scene, struct skinned *skinned)
{
    *skinned = (struct skinned){ .joints = { 0, 1 } };
    struct scene_pose rest;
    CHECK(pose_init(&rest, scene, -1, 0));
    for (int j = 0; j < 2; j++) {
        skinned->joint_from_mesh[j] = glms_mat4_inv(rest.world_from_node[j]);
    }
    pose_finish(&rest);
    skinned->skin = (struct skin){ 2, skinned->joints, skinned->joint_from_mesh };
    scene->skins = &skinned->skin;
    scene->skin_count = 1;
    uint16_t joints[3][4] = { { 0 }, { 1, 0 }, { 0, 1 } };
    vec4s weights[3] = { { { 1 } }, { { 1 } }, { { 0.5f, 0.5f } } };
    struct mesh mesh = triangle();
    mesh.joints = joints;
    mesh.weights = weights;
    struct instance instance = { .node = 1, .mesh = scene_add_mesh(scene, &mesh), .skin = 0 };
    CHECK(scene_add_instance(scene, &instance) == 0);
}

TEST(a_skin_in_bind_pose_leaves_the_mesh_unchanged)
{
    struct scene *scene = parent_and_child();
    struct skinned skinned;
    add_skinned(scene, &skinned);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    for (int v = 0; v < 3; v++) {
        check_vec3(pose.deformed[0].positions[v], positions[v], 1e-5);
        check_vec3(pose.deformed[0].normals[v], normals[v], 1e-5);
        CHECK_NEAR(pose.deformed[0].tangents[v].x, 1, 1e-5);
        CHECK_NEAR(pose.deformed[0].tangents[v].w, tangents[v].w, 0);
    }
    mat4s identity = glms_mat4_identity(), world = pose_world_from_instance(&pose, 0);
    CHECK(memcmp(&world, &identity, sizeof world) == 0);
    check_vec3(pose.bounds.max, vec3_of(1, 2, 0), 1e-5);
    pose_finish(&pose);
    scene->skin_count = 0;
    scene_destroy(scene);
}

TEST(a_skinned_vertex_follows_its_joint)
{
    struct scene *scene = parent_and_child();
    struct skinned skinned;
    add_skinned(scene, &skinned);
    float times[1] = { 0 }, values[3] = { 1, 2, 13 }; // node 0 is translated by 10 along z
    struct animation_channel c = channel(PATH_TRANSLATION, INTERPOLATE_STEP, 3, 1, times, values);
    struct animation animation;
    set_animation(scene, &animation, &c, 1, 0);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, 0, 0));
    for (int v = 0; v < 3; v++) {
        vec3s moved = glms_vec3_add(positions[v], vec3_of(0, 0, 10));
        check_vec3(pose.deformed[0].positions[v], moved, 1e-4);
        check_vec3(pose.deformed[0].normals[v], normals[v], 1e-5);
    }
    pose_finish(&pose);
    scene->skin_count = 0;
    scene->animation_count = 0;
    scene_destroy(scene);
}

TEST(morph_weights_add)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct node node = node_default();
    node.translation = vec3_of(0, 0, 5);
    CHECK(scene_add_node(scene, &node) == 0);
    vec3s right[3] = { { { 1, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 0, 0 } } };
    vec3s lift[3] = { { { 0, 1, 0 } }, { { 0, 2, 0 } }, { { 0, 3, 0 } } };
    struct morph_target morphs[2] = { { right, NULL }, { lift, NULL } };
    struct mesh mesh = triangle();
    mesh.morphs = morphs;
    mesh.morph_count = 2;
    CHECK(scene_add_mesh(scene, &mesh) == 0);
    float weights[2] = { 0.5f, 2 };
    struct instance instance = { .skin = -1, .morph_weights = weights };
    CHECK(scene_add_instance(scene, &instance) == 0);
    instance.morph_weights = NULL; // all zero
    CHECK(scene_add_instance(scene, &instance) == 1);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    check_vec3(pose.deformed[0].positions[2], vec3_of(0.5f, 2 + 6, 5), 1e-6);
    check_vec3(pose.deformed[1].positions[2], vec3_of(0, 2, 5), 1e-6);

    float times[1] = { 0 }, values[2] = { 1, 0 };
    struct animation_channel c = channel(PATH_WEIGHTS, INTERPOLATE_LINEAR, 2, 1, times, values);
    struct animation animation;
    set_animation(scene, &animation, &c, 1, 0);
    pose_update(&pose, 0, 0);
    check_vec3(pose.deformed[0].positions[2], vec3_of(1, 2, 5), 1e-6);
    CHECK_NEAR(pose.morph_weights[pose.morph_offset[1]], 1, 0);
    pose_finish(&pose);
    scene->animation_count = 0;
    scene_destroy(scene);
}

TEST(lights_and_cameras_face_minus_z_of_their_nodes)
{
    struct scene *scene = parent_and_child();
    struct light light = { .name = "spot",
                           .type = LIGHT_SPOT,
                           .node = 1,
                           .intensity = vec3_of(1, 2, 3),
                           .inner_rad = 0,
                           .outer_rad = 0.5f,
                           .range_m = 4 };
    CHECK(scene_add_light(scene, &light) == 0);
    struct camera camera = { .name = "c", .node = 1, .vertical_fov_rad = 1, .near_m = 0.1f };
    CHECK(scene_add_camera(scene, &camera) == 0);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0));
    struct world_light shining = pose_light(&pose, 0);
    check_vec3(shining.position, vec3_of(2, 2, 3), 1e-5);
    check_vec3(shining.direction, vec3_of(-1, 0, 0), 1e-6);
    CHECK_NEAR(shining.cos_inner, 1, 0);
    CHECK_NEAR(shining.cos_outer, cos(0.5), 1e-6);
    struct world_camera seen = pose_camera(&pose, 0);
    check_vec3(seen.forward, vec3_of(-1, 0, 0), 1e-6);
    check_vec3(seen.up, vec3_of(0, 1, 0), 1e-6);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(camera_look_at_gives_an_orthonormal_frame_in_every_direction)
{
    static const float along[7][3] = { { 1, 0, 0 }, { 0, 0, -2 },    { 0, 3, 0 }, { 0, -3, 0 },
                                       { 1, 1, 1 }, { 1e-4f, 5, 0 }, { 0, 0, 0 } };
    for (int i = 0; i < 7; i++) {
        vec3s position = vec3_of(1, 2, 3);
        vec3s direction = vec3_of(along[i][0], along[i][1], along[i][2]);
        struct world_camera camera =
            camera_look_at(position, glms_vec3_add(position, direction), 1, 0.1f);
        CHECK_NEAR(glms_vec3_norm(camera.forward), 1, 1e-5);
        CHECK_NEAR(glms_vec3_norm(camera.up), 1, 1e-5);
        CHECK_NEAR(glms_vec3_dot(camera.up, camera.forward), 0, 1e-5);
        float length = glms_vec3_norm(direction);
        if (length > 0) CHECK_NEAR(glms_vec3_dot(camera.forward, direction) / length, 1, 1e-5);
    }
}

TEST(scene_add_node_looking_faces_its_direction)
{
    struct scene *scene = scene_create(test_host(), "test");
    static const float along[4][3] = { { 1, 2, 3 }, { 0, -1, 0 }, { 0, 1, 0 }, { 0, 0, 4 } };
    for (int i = 0; i < 4; i++) {
        vec3s direction = vec3_of(along[i][0], along[i][1], along[i][2]);
        CHECK(scene_add_node_looking(scene, "n", vec3_of(7, 8, 9), direction) == i);
        mat4s m = scene->nodes[i].matrix;
        vec3s back = vec3_xyz(m.col[2]);
        check_vec3(back, glms_vec3_scale(glms_vec3_normalize(direction), -1), 1e-6);
        CHECK_NEAR(glms_mat4_det(m), 1, 1e-5);
    }
    CHECK(scene_add_node_looking(scene, "n", vec3_of(0, 0, 0), vec3_of(0, 0, 0)) == -1);
    CHECK(scene_add_node_looking(scene, "n", vec3_of(0, NAN, 0), vec3_of(0, 0, 1)) == -1);
    scene_destroy(scene);
}
