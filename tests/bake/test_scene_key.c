// Hashes of scenes: each part changes them, and nothing else does.
#include "bake/scene_key.h"
#include "scene/scene_edit.h"

#include "framework/test.h"

#include <string.h>

static struct scene *load(const char *name)
{
    struct scene *scene = scene_load(test_host(), name);
    assert_non_null(scene);
    return scene;
}

static struct hash128 key_at(const struct scene *scene, float time_s, unsigned parts)
{
    struct scene_pose pose;
    CHECK(pose_init(&pose, scene, -1, time_s));
    const struct hash128 key = scene_key(&pose, parts);
    pose_finish(&pose);
    return key;
}

static bool same(struct hash128 a, struct hash128 b)
{
    return a.high == b.high && a.low == b.low;
}

static const unsigned BOTH = SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS;

TEST(scene_key_is_the_same_for_the_same_scene)
{
    struct scene *a = load("@atrium"), *b = load("@atrium");
    CHECK(same(key_at(a, 0, BOTH), key_at(b, 1, BOTH)));
    CHECK(!same(key_at(a, 0, BOTH), key_at(b, 0, SCENE_KEY_GEOMETRY)));
    scene_destroy(a);
    scene_destroy(b);
}

TEST(scene_key_does_not_depend_on_lights_sky_and_cameras)
{
    struct scene *a = load("@atrium"), *b = load("@atrium");
    scene_remove_lights(b);
    b->environment.sky = vec3_of(1, 2, 3);
    b->camera_count = 0;
    CHECK(same(key_at(a, 0, BOTH), key_at(b, 0, BOTH)));
    scene_destroy(a);
    scene_destroy(b);
}

TEST(scene_key_of_geometry_depends_on_a_vertex_a_triangle_and_a_transform)
{
    struct scene *scene = load("@cornell");
    const struct hash128 key = key_at(scene, 0, SCENE_KEY_GEOMETRY);
    const struct hash128 materials = key_at(scene, 0, SCENE_KEY_MATERIALS);
    struct mesh *mesh = &scene->meshes[scene->instances[0].mesh];
    mesh->positions[0].x += 0.001f;
    CHECK(!same(key_at(scene, 0, SCENE_KEY_GEOMETRY), key));
    CHECK(same(key_at(scene, 0, SCENE_KEY_MATERIALS), materials));
    mesh->positions[0].x -= 0.001f;
    const uint32_t index = mesh->indices[0];
    mesh->indices[0] = mesh->indices[1];
    CHECK(!same(key_at(scene, 0, SCENE_KEY_GEOMETRY), key));
    mesh->indices[0] = index;
    struct node *node = &scene->nodes[scene->instances[0].node];
    node->has_matrix = false;
    node->translation.y += 1.0f;
    CHECK(!same(key_at(scene, 0, SCENE_KEY_GEOMETRY), key));
    scene_destroy(scene);
}

TEST(scene_key_of_materials_depends_on_factors_and_texels)
{
    struct scene *scene = load("@atrium");
    const struct hash128 key = key_at(scene, 0, SCENE_KEY_MATERIALS);
    const struct hash128 geometry = key_at(scene, 0, SCENE_KEY_GEOMETRY);
    struct material *material = &scene->materials[scene->meshes[scene->instances[0].mesh].material];
    material->base_color.y += 0.01f;
    CHECK(!same(key_at(scene, 0, SCENE_KEY_MATERIALS), key));
    CHECK(same(key_at(scene, 0, SCENE_KEY_GEOMETRY), geometry));
    material->base_color.y -= 0.01f;
    for (int i = 0; i < scene->image_count; i++) scene->images[i].rgba[0] ^= 1;
    CHECK(scene->image_count == 0 || !same(key_at(scene, 0, SCENE_KEY_MATERIALS), key));
    scene_destroy(scene);
}
