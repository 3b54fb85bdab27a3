// scene_add_*: copies, generated data, refused arguments.
#include "framework/test.h"

#include "scene/scene.h"
#include "scene/scene_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static vec3s square_positions[4] = {
    { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0 } }
};
static vec3s square_normals[4] = {
    { { 0, 0, 1 } }, { { 0, 0, 1 } }, { { 0, 0, 1 } }, { { 0, 0, 1 } }
};
static vec2s square_uv[4] = { { { 0, 1 } }, { { 1, 1 } }, { { 1, 0 } }, { { 0, 0 } } };
static uint32_t square_indices[6] = { 0, 1, 2, 0, 2, 3 };

static struct mesh square(void)
{
    return (struct mesh){
        .name = "square",
        .vertex_count = 4,
        .index_count = 6,
        .positions = square_positions,
        .normals = square_normals,
        .uv = { square_uv, NULL },
        .indices = square_indices,
    };
}

static struct scene *scene_with_square(void)
{
    struct scene *scene = scene_create(test_host(), "test");
    CHECK(scene);
    struct mesh mesh = square();
    CHECK(scene_add_mesh(scene, &mesh) == 0);
    struct node node = node_default();
    CHECK(scene_add_node(scene, &node) == 0);
    struct instance instance = { .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) == 0);
    return scene;
}

TEST(an_empty_scene_has_no_triangles_and_no_emission)
{
    struct scene *scene = scene_create(test_host(), "empty");
    CHECK(scene && scene->mesh_count == 0 && scene_triangle_count(scene) == 0);
    CHECK_STRING(scene->name, "empty");
    CHECK(!scene_has_emission(scene));
    scene_destroy(scene);
    scene_destroy(NULL);
}

TEST(additions_are_copies)
{
    char name[] = "first";
    vec3s positions[4];
    memcpy(positions, square_positions, sizeof positions);
    struct scene *scene = scene_create(test_host(), "test");
    struct mesh mesh = square();
    mesh.name = name;
    mesh.positions = positions;
    CHECK(scene_add_mesh(scene, &mesh) == 0);
    memset(positions, 0xff, sizeof positions);
    memset(name, 'x', sizeof name - 1);
    CHECK_STRING(scene->meshes[0].name, "first");
    CHECK_NEAR(scene->meshes[0].positions[2].y, 1, 0);
    CHECK_NEAR(scene->meshes[0].bounds.max.x, 1, 0);
    scene_destroy(scene);
}

TEST(indices_are_consecutive_over_many_additions)
{
    struct scene *scene = scene_with_square();
    for (int i = 1; i < 1000; i++) {
        struct node node = node_default();
        node.parent = i - 1;
        node.translation.x = (float)i;
        CHECK(scene_add_node(scene, &node) == i);
        struct instance instance = { .node = i, .skin = -1 };
        CHECK(scene_add_instance(scene, &instance) == i);
    }
    CHECK_NEAR(scene->nodes[500].translation.x, 500, 0);
    CHECK(scene_triangle_count(scene) == 2000);
    CHECK(scene_memory_bytes(scene) > 1000 * (sizeof(struct node) + sizeof(struct instance)));
    scene_destroy(scene);
}

TEST(arrays_set_directly_survive_an_addition)
{
    struct scene *scene = scene_create(test_host(), "test");
    scene->nodes = arena_alloc(&scene->arena, 3, sizeof *scene->nodes);
    CHECK(scene->nodes);
    for (int i = 0; i < 3; i++) {
        scene->nodes[i] = node_default();
        scene->nodes[i].translation.x = (float)i;
    }
    scene->node_count = 3;
    struct node node = node_default();
    CHECK(scene_add_node(scene, &node) == 3);
    CHECK_NEAR(scene->nodes[2].translation.x, 2, 0);
    scene_destroy(scene);
}

TEST(a_mesh_without_material_gets_a_default_one)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct mesh mesh = square();
    CHECK(scene_add_mesh(scene, &mesh) == 0);
    CHECK(scene->material_count == 1 && scene->meshes[0].material == 0);
    CHECK_NEAR(scene->materials[0].base_color.x, 1, 0);
    mesh.material = -1;
    CHECK(scene_add_mesh(scene, &mesh) == 1);
    CHECK(scene->meshes[1].material == 1);
    mesh.material = 2;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    CHECK(scene->mesh_count == 2);
    scene_destroy(scene);
}

TEST(missing_normals_are_generated_and_others_normalised)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct mesh mesh = square();
    mesh.normals = NULL;
    CHECK(scene_add_mesh(scene, &mesh) == 0);
    CHECK_NEAR(scene->meshes[0].normals[0].z, 1, 1e-6);
    vec3s long_normals[4] = { { { 0, 0, 3 } }, { { 0, 4, 0 } }, { { 5, 0, 0 } }, { { 0, 0, 0 } } };
    mesh.normals = long_normals;
    CHECK(scene_add_mesh(scene, &mesh) == 1);
    for (int v = 0; v < 4; v++) CHECK_NEAR(glms_vec3_norm(scene->meshes[1].normals[v]), 1, 1e-6);
    CHECK(!scene->meshes[1].tangents);
    scene_destroy(scene);
}

TEST(tangents_are_generated_for_a_normal_map)
{
    struct scene *scene = scene_create(test_host(), "test");
    uint8_t flat[4] = { 128, 128, 255, 255 };
    struct scene_image image = { .name = "flat", .width = 1, .height = 1, .rgba = flat };
    CHECK(scene_add_image(scene, &image) == 0);
    struct material material = material_default();
    material.normal_map.image = 0;
    CHECK(scene_add_material(scene, &material) == 0);
    struct mesh mesh = square();
    CHECK(scene_add_mesh(scene, &mesh) == 0);
    CHECK(scene->meshes[0].tangents);
    CHECK_NEAR(scene->meshes[0].tangents[0].x, 1, 1e-5); // along u
    scene_destroy(scene);
}

TEST(has_alpha_is_set_for_images_that_are_not_opaque)
{
    struct scene *scene = scene_create(test_host(), "test");
    uint8_t texels[8] = { 0, 0, 0, 255, 0, 0, 0, 255 };
    struct scene_image image = { .name = "a", .width = 2, .height = 1, .rgba = texels };
    CHECK(scene_add_image(scene, &image) == 0 && !scene->images[0].has_alpha);
    texels[7] = 254;
    CHECK(scene_add_image(scene, &image) == 1 && scene->images[1].has_alpha);
    image.width = SCENE_MAX_IMAGE_SIZE + 1;
    CHECK(scene_add_image(scene, &image) == -1);
    image.width = 0;
    CHECK(scene_add_image(scene, &image) == -1);
    scene_destroy(scene);
}

TEST(a_mesh_with_bad_indices_is_refused)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct mesh mesh = square();
    uint32_t indices[6] = { 0, 1, 2, 0, 2, 4 };
    mesh.indices = indices;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    mesh = square();
    mesh.index_count = 5;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    mesh = square();
    mesh.positions = NULL;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    mesh = square();
    mesh.morph_count = 1;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    CHECK(scene->mesh_count == 0);
    scene_destroy(scene);
}

TEST(a_mesh_that_is_not_finite_is_refused)
{
    struct scene *scene = scene_create(test_host(), "test");
    vec3s bad[4];
    memcpy(bad, square_positions, sizeof bad);
    bad[3].z = NAN;
    struct mesh mesh = square();
    mesh.positions = bad;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    CHECK(strstr(test_last_message(), "square"));
    mesh = square();
    mesh.normals = bad;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    struct morph_target morph = { .positions = bad };
    mesh = square();
    mesh.morphs = &morph;
    mesh.morph_count = 1;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    vec2s bad_uv[4] = { { { 0, INFINITY } } };
    mesh = square();
    mesh.uv[1] = bad_uv;
    CHECK(scene_add_mesh(scene, &mesh) == -1);
    CHECK(scene->mesh_count == 0);
    scene_destroy(scene);
}

TEST(a_material_out_of_range_is_refused)
{
    struct scene *scene = scene_create(test_host(), "test");
    struct material material = material_default();
    material.base_color_map.image = 0;
    CHECK(scene_add_material(scene, &material) == -1);
    material = material_default();
    material.roughness = 1.5f;
    CHECK(scene_add_material(scene, &material) == -1);
    material = material_default();
    material.emissive.y = -1;
    CHECK(scene_add_material(scene, &material) == -1);
    material = material_default();
    material.base_color.z = NAN;
    CHECK(scene_add_material(scene, &material) == -1);
    CHECK(scene->material_count == 0);
    scene_destroy(scene);
}

TEST(nodes_and_instances_with_invalid_indices_are_refused)
{
    struct scene *scene = scene_with_square();
    struct node node = node_default();
    node.parent = 1; // its own index
    CHECK(scene_add_node(scene, &node) == -1);
    node = node_default();
    node.translation.x = INFINITY;
    CHECK(scene_add_node(scene, &node) == -1);
    node = node_default();
    node.rotation = (versors){ { 0, 0, 0, 0 } };
    CHECK(scene_add_node(scene, &node) == -1);
    struct instance instance = { .mesh = 1, .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) == -1);
    instance = (struct instance){ .node = 1, .skin = -1 };
    CHECK(scene_add_instance(scene, &instance) == -1);
    instance = (struct instance){ .skin = 0 };
    CHECK(scene_add_instance(scene, &instance) == -1);
    CHECK(scene->node_count == 1 && scene->instance_count == 1);
    scene_destroy(scene);
}

TEST(lights_and_cameras_out_of_range_are_refused)
{
    struct scene *scene = scene_with_square();
    struct light light = { .name = "l", .type = LIGHT_POINT, .intensity = vec3_of(1, 1, 1) };
    CHECK(scene_add_light(scene, &light) == 0);
    struct light bad = light;
    bad.node = 7;
    CHECK(scene_add_light(scene, &bad) == -1);
    bad = light;
    bad.intensity.x = NAN;
    CHECK(scene_add_light(scene, &bad) == -1);
    bad = light;
    bad.type = LIGHT_SPOT; // inner = outer = 0
    CHECK(scene_add_light(scene, &bad) == -1);
    bad.outer_rad = 0.5f;
    CHECK(scene_add_light(scene, &bad) == 1);
    struct camera camera = { .name = "c", .vertical_fov_rad = 1, .near_m = 0.1f };
    CHECK(scene_add_camera(scene, &camera) == 0);
    camera.vertical_fov_rad = 4;
    CHECK(scene_add_camera(scene, &camera) == -1);
    camera.vertical_fov_rad = 1;
    camera.near_m = 0;
    CHECK(scene_add_camera(scene, &camera) == -1);
    scene_remove_lights(scene);
    CHECK(scene->light_count == 0 && scene->camera_count == 1);
    CHECK(scene_add_light(scene, &light) == 0);
    scene_destroy(scene);
}

TEST(a_skin_must_have_the_joints_that_its_mesh_uses)
{
    struct scene *scene = scene_with_square();
    int joints[2] = { 0, 0 };
    mat4s joint_from_mesh[2] = { glms_mat4_identity(), glms_mat4_identity() };
    struct skin skin = { 2, joints, joint_from_mesh };
    scene->skins = &skin;
    scene->skin_count = 1;
    uint16_t vertex_joints[4][4] = { { 0 }, { 1 }, { 0 }, { 2 } };
    vec4s weights[4] = { { { 2, 0, 0, 0 } }, { { 1, 1, 0, 0 } }, { { 0, 0, 0, 0 } }, { { 1 } } };
    struct mesh mesh = square();
    mesh.joints = vertex_joints;
    CHECK(scene_add_mesh(scene, &mesh) == -1); // no weights
    mesh.weights = weights;
    CHECK(scene_add_mesh(scene, &mesh) == 1);
    for (int v = 0; v < 4; v++) {
        vec4s w = scene->meshes[1].weights[v];
        CHECK_NEAR(w.x + w.y + w.z + w.w, 1, 1e-6);
    }
    struct instance instance = { .mesh = 1, .skin = 0 };
    CHECK(scene_add_instance(scene, &instance) == -1); // joint 2
    vertex_joints[3][0] = 1;
    CHECK(scene_add_mesh(scene, &mesh) == 2);
    instance.mesh = 2;
    CHECK(scene_add_instance(scene, &instance) == 1);
    instance.mesh = 0; // has no joints
    CHECK(scene_add_instance(scene, &instance) == -1);
    scene->skin_count = 0;
    scene_destroy(scene);
}

// Fails every allocation after the first `allowed`.
static int allowed;

static void *failing_reallocate(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes == 0) {
        free(old);
        return NULL;
    }
    return allowed-- > 0 ? realloc(old, bytes) : NULL;
}

TEST(out_of_memory_fails_without_a_leak)
{
    struct host host = host_default();
    host.reallocate = failing_reallocate;
    int succeeded_at = -1;
    // Each of the first hundred allocations, then one in fifty: under the address sanitizer an
    // arena makes thousands.
    for (int budget = 0; budget < 200000 && succeeded_at < 0; budget += 1 + budget / 100 * 2) {
        allowed = budget;
        struct scene *scene = scene_create(&host, "small");
        struct mesh mesh = square();
        struct node node = node_default();
        bool added = scene != NULL;
        for (int i = 0; i < 2000 && added; i++) {
            added = scene_add_mesh(scene, &mesh) >= 0 && scene_add_node(scene, &node) >= 0;
        }
        if (!added) CHECK(host.failure == FAIL_MEMORY);
        if (added) succeeded_at = budget;
        scene_destroy(scene);
    }
    CHECK(succeeded_at > 1);
}
