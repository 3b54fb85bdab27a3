// Files of the test scene folder: each loads with its documented contents, or is refused with a
// message that names the cause.
#include "framework/test.h"

#include "scene/pose.h"
#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

struct expected {
    const char *file;
    size_t triangles;
    float min[3], max[3]; // node transforms applied, rest pose, no skinning
    int images, lights, skins, animations;
    const char *warning; // part of the message, "" when there is none
};

static const struct expected scenes[] = {
    { "sponza.glb",
      262267,
      { -15.365f, -1.012f, -9.462f },
      { 14.395f, 11.435f, 8.842f },
      65,
      0,
      0,
      0,
      "" },
    { "bunny.glb",
      69451,
      { -0.095f, 0.033f, -0.062f },
      { 0.061f, 0.187f, 0.059f },
      0,
      0,
      0,
      0,
      "" },
    { "head-lee-perry-smith.glb",
      17684,
      { -4.276f, -3.973f, -2.59f },
      { 4.276f, 3.973f, 2.59f },
      2,
      0,
      0,
      0,
      "" },
    { "box-animated.gltf", 254, { -0.5f, -0.5f, -0.5f }, { 0.5f, 0.5f, 0.5f }, 0, 0, 0, 1, "" },
    { "fox.glb",
      576,
      { -12.593f, -0.122f, -88.095f },
      { 12.593f, 78.907f, 66.625f },
      1,
      0,
      1,
      3,
      "" },
    { "robot-expressive.glb",
      3237,
      { -3.312f, -0.02f, -1.269f },
      { 3.307f, 4.441f, 1.416f },
      0,
      0,
      2,
      14,
      "" },
    { "littlest-tokyo.glb",
      88978,
      { -359.114f, -211.275f, -301.266f },
      { 185.186f, 222.076f, 250.44f },
      3,
      0,
      1,
      1,
      "" },
    { "bedroom.glb",
      10457,
      { -5.414f, -3.094f, -4.867f },
      { 5.414f, 3.094f, 2.997f },
      6,
      0,
      0,
      0,
      "" },
    { "cornell-box-emissive.glb",
      36,
      { -556.0f, 0.0f, -559.2f },
      { 0.0f, 548.8f, 0.0f },
      0,
      0,
      0,
      0,
      "" },
    { "coloured-walls.glb",
      32,
      { -20.2f, -0.923f, -20.2f },
      { 20.352f, 0.0f, 20.503f },
      0,
      0,
      0,
      0,
      "" },
    { "window-sun-light.glb",
      360,
      { -3.16f, 0.016f, -6.742f },
      { 3.16f, 6.322f, 6.742f },
      1,
      1,
      0,
      0,
      "" },
    { "circuit-emissive-sun.glb",
      10610,
      { -3.238f, 0.168f, -3.238f },
      { 3.238f, 1.175f, 3.238f },
      5,
      1,
      0,
      0,
      "" },
    { "cubes-point-light.glb",
      36,
      { -4.284f, -1.938f, -2.994f },
      { 4.603f, 3.591f, 3.639f },
      0,
      1,
      0,
      0,
      "" },
    { "mixed-lighting.glb",
      40898,
      { -1.554f, 0.0f, -1.554f },
      { 1.554f, 0.686f, 1.554f },
      7,
      1,
      0,
      0,
      "KHR_materials_sheen" },
    { "flight-helmet.glb",
      94722,
      { -0.204f, 0.0f, -0.172f },
      { 0.163f, 0.716f, 0.2f },
      15,
      0,
      0,
      0,
      "" },
};

struct odd {
    const char *file;
    size_t triangles; // SIZE_MAX: refused
    const char *message;
};

static const struct odd odd[] = {
    { "positions-only.glb", 80, "" },
    { "line-primitives.glb", 3230, "line primitives" },
    { "unlit.glb", 20, "" },
    { "vertex-colours.glb", 12, "" },
    { "embedded-uris.gltf", 12, "" },
    { "simple-skin.gltf", 8, "" },
    { "morph-stress.gltf", 2412, "" },
    { "custom-attribute.gltf", 2, "__BARYCENTRIC" },
    { "many-cubes.gltf", 6012, "" },
    { "sparse-accessors.gltf", 0, "" },
    { "ktx2-image/checkerboard.gltf", 2, "neither JPEG nor PNG" },
    { "index-out-of-range/index_buffer_oob.gltf", SIZE_MAX, "index" },
    { "node-loop.gltf", SIZE_MAX, "child" },
    { "missing-buffer.gltf", SIZE_MAX, "not_found.bin" },
    { "truncated.glb", SIZE_MAX, "47 bytes of the 48" },
    { "version-1.gltf", SIZE_MAX, "1.0" },
    { "draco-required.glb", SIZE_MAX, "KHR_draco_mesh_compression" },
    { "draco-not-required/BoxDraco.gltf", SIZE_MAX, "KHR_draco_mesh_compression" },
    { "meshopt-required.glb", SIZE_MAX, "EXT_meshopt_compression" },
    { "unknown-extension-required/ACMEBox.gltf", SIZE_MAX, "ACME_gizmo" },
};

static struct scene *load(const char *file)
{
    test_forget_messages();
    return scene_load(test_host(), test_scene_path(file));
}

// Bounds of all instances transformed by their nodes, without skinning.
static struct box3 node_bounds(const struct scene *scene)
{
    struct scene_pose pose;
    struct box3 box = box3_empty();
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    for (int i = 0; i < scene->instance_count; i++) {
        const struct mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        mat4s world_from_node = pose.world_from_node[scene->instances[i].node];
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            box = box3_add_point(box, mat4_point(world_from_node, mesh->positions[v]));
        }
    }
    pose_finish(&pose);
    return box;
}

static void check_mesh(const struct scene *scene, const struct mesh *mesh)
{
    CHECK(mesh->index_count % 3 == 0 && mesh->normals);
    CHECK(mesh->material >= 0 && mesh->material < scene->material_count);
    for (uint32_t i = 0; i < mesh->index_count; i++) CHECK(mesh->indices[i] < mesh->vertex_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        CHECK_NEAR(glms_vec3_norm(mesh->normals[v]), 1.0, 1e-4);
        if (!mesh->tangents) continue;
        CHECK_NEAR(glms_vec3_norm(vec3_xyz(mesh->tangents[v])), 1.0, 1e-4);
        CHECK_NEAR(glms_vec3_dot(vec3_xyz(mesh->tangents[v]), mesh->normals[v]), 0.0, 1e-4);
        CHECK(mesh->tangents[v].w == 1.0f || mesh->tangents[v].w == -1.0f);
    }
    const struct texture_use *map = &scene->materials[mesh->material].normal_map;
    if (map->image >= 0 && mesh->uv[map->uv_set]) CHECK(mesh->tangents);
}

TEST(files_have_their_documented_triangles_bounds_and_contents)
{
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const struct expected *want = &scenes[i];
        struct scene *scene = load(want->file);
        if (!scene) fail_msg("%s: %s", want->file, test_last_message());
        if (!want->warning[0]) CHECK_STRING(test_last_message(), "");
        CHECK(strstr(test_last_message(), want->warning));
        CHECK(scene_triangle_count(scene) == want->triangles);
        CHECK(scene->image_count == want->images);
        CHECK(scene->light_count == want->lights);
        CHECK(scene->skin_count == want->skins);
        CHECK(scene->animation_count == want->animations);
        struct box3 box = node_bounds(scene);
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(box.min.raw[k], want->min[k], 6e-4);
            CHECK_NEAR(box.max.raw[k], want->max[k], 6e-4);
        }
        for (int m = 0; m < scene->mesh_count; m++) check_mesh(scene, &scene->meshes[m]);
        scene_destroy(scene);
    }
}

TEST(odd_files_load_or_are_refused_with_the_cause)
{
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        char file[128];
        snprintf(file, sizeof file, "odd/%s", odd[i].file);
        struct scene *scene = load(file);
        bool as_expected = odd[i].triangles == SIZE_MAX
                               ? !scene
                               : scene && scene_triangle_count(scene) == odd[i].triangles;
        if (!as_expected || !strstr(test_last_message(), odd[i].message) ||
            (!odd[i].message[0] && test_last_message()[0])) {
            fail_msg("%s: \"%s\"", odd[i].file, test_last_message());
        }
        for (int m = 0; scene && m < scene->mesh_count; m++) check_mesh(scene, &scene->meshes[m]);
        scene_destroy(scene);
    }
}

// The tangents of the Khronos Sponza have w = -1 for unmirrored mapping: its normal maps point
// along +v.
TEST(tangents_of_the_file_keep_their_handedness)
{
    struct scene *scene = load("sponza.glb");
    CHECK(scene);
    size_t negative = 0, all = 0;
    for (int m = 0; m < scene->mesh_count; m++) {
        const struct mesh *mesh = &scene->meshes[m];
        for (uint32_t v = 0; mesh->tangents && v < mesh->vertex_count; v++) {
            negative += mesh->tangents[v].w < 0.0f;
            all++;
        }
    }
    CHECK(all > 100000 && negative > all / 2);
    scene_destroy(scene);
}

TEST(light_units_are_those_of_the_file)
{
    struct scene *scene = load("cubes-point-light.glb");
    CHECK(scene && scene->lights[0].type == LIGHT_POINT);
    CHECK_NEAR(scene->lights[0].intensity.x, 79.6, 0.05);
    scene_destroy(scene);
    scene = load("window-sun-light.glb");
    CHECK(scene && scene->lights[0].type == LIGHT_SUN);
    CHECK_NEAR(scene->lights[0].intensity.x, 68300.0, 100.0); // red is 1
    scene_destroy(scene);
    scene = load("cornell-box-emissive.glb");
    CHECK(scene && scene_has_emission(scene));
    float brightest = 0.0f;
    for (int i = 0; i < scene->material_count; i++) {
        brightest = fmaxf(brightest, scene->materials[i].emissive.x);
    }
    CHECK_NEAR(brightest, 100.0, 1e-3);
    scene_destroy(scene);
}

TEST(mirrored_nodes_keep_their_transform)
{
    struct scene *scene = load("coloured-walls.glb");
    CHECK(scene);
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, 0.0f));
    int mirrored = 0;
    for (int i = 0; i < scene->instance_count; i++) {
        mirrored += glms_mat4_det(pose.world_from_node[scene->instances[i].node]) < 0.0f;
    }
    CHECK(mirrored > 0);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(masked_materials_have_alpha_mode_mask)
{
    struct scene *scene = load("sponza.glb");
    CHECK(scene);
    int masked = 0;
    for (int i = 0; i < scene->material_count; i++) {
        const struct material *m = &scene->materials[i];
        if (m->alpha_mode != ALPHA_MASK) continue;
        masked++;
        CHECK(scene->images[m->base_color_map.image].has_alpha);
    }
    CHECK(masked == 3);
    scene_destroy(scene);
}
