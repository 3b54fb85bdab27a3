// Copies of scenes as glTF have the environment: all floats of its map, and its sun once.
#include "framework/test.h"

#include "core/files/file.h"
#include "scene/environment/environment_map.h"
#include "scene/export/gltf_doc.h"
#include "scene/pose.h"
#include "scene/scene_edit.h"
#include "../scene/image_light_maker.h"

#include <math.h>

static struct scene *written(struct gltf_doc *doc, const char *name)
{
    CHECK(gltf_doc_write(doc, test_path(name)));
    gltf_doc_finish(doc);
    test_forget_messages();
    struct scene *scene = scene_load(test_host(), test_path(name));
    if (!scene) fail_msg("%s", test_last_message());
    return scene;
}

static struct scene *copy_of_file(const struct scene *scene, const char *name)
{
    struct gltf_doc doc;
    bool same;
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    return written(&doc, name);
}

static struct scene *copy_of_scene(const struct scene *scene, const char *name)
{
    struct gltf_doc doc;
    CHECK(gltf_doc_of_scene(&doc, test_host(), scene));
    return written(&doc, name);
}

static void light_by_sky(struct scene *scene)
{
    const struct sun_sky sky = { .elevation_rad = 0.5f, .azimuth_rad = 1.0f, .turbidity = 3.0f };
    struct environment_map *map = environment_map_of_sky(test_host(), &sky);
    assert_non_null(map);
    CHECK(map->sun.found);
    scene_set_environment_map(scene, map, 0.7f, 2.1f);
    environment_map_release(map);
}

static void check_environment(const struct scene *a, const struct scene *b)
{
    struct scene_pose x, y;
    CHECK(b->environment.map &&
          environment_key(&a->environment) == environment_key(&b->environment));
    CHECK(strcmp(a->environment.map->name, b->environment.map->name) == 0);
    CHECK(a->environment.map->sun.radius_rad == b->environment.map->sun.radius_rad);
    CHECK(pose_init(&x, a, -1, 0) && pose_init(&y, b, -1, 0));
    const int count = pose_light_count(&x);
    assert_int_equal(count, pose_light_count(&y));
    for (int i = 0; i < count; i++) {
        const struct world_light p = pose_light(&x, i), q = pose_light(&y, i);
        CHECK(p.type == q.type && memcmp(&p.intensity, &q.intensity, sizeof p.intensity) == 0);
        CHECK_NEAR(glms_vec3_dot(p.direction, q.direction), 1, 1e-6);
    }
    pose_finish(&x);
    pose_finish(&y);
}

static const json_t *sun_of(const struct gltf_doc *doc)
{
    const json_t *extensions = json_object_get(doc->root, "extensions");
    const json_t *lights =
        json_object_get(json_object_get(extensions, "KHR_lights_punctual"), "lights");
    return json_array_get(lights, json_array_size(lights) - 1);
}

TEST(scenes_made_by_code_keep_their_environment)
{
    struct scene *scene = scene_load(test_host(), "@cornell:light=point");
    assert_non_null(scene);
    light_by_sky(scene);
    struct scene *copy = copy_of_scene(scene, "copy.glb");
    check_environment(scene, copy);
    struct scene *second = copy_of_file(copy, "second.glb"), *third = copy_of_scene(copy, "3.glb");
    check_environment(scene, second);
    check_environment(scene, third);
    scene_destroy(third);
    scene_destroy(second);
    scene_destroy(copy);
    scene_destroy(scene);
}

// Readers that do not know the extras get the sun from a light of the file.
TEST(the_sun_is_a_light_that_other_readers_see)
{
    struct gltf_doc doc;
    struct world_light sun;
    struct scene *scene = scene_load(test_host(), "@spheres");
    assert_non_null(scene);
    light_by_sky(scene);
    CHECK(environment_sun_light(&scene->environment, &sun));
    CHECK(gltf_doc_of_scene(&doc, test_host(), scene));
    json_t *light = (json_t *)sun_of(&doc);
    CHECK(json_object_del(json_object_get(light, "extras"), "afterglow_environment_sun") == 0);
    struct scene *copy = written(&doc, "copy.glb");
    struct scene_pose pose;
    CHECK(pose_init(&pose, copy, -1, 0));
    assert_int_equal(copy->light_count, scene->light_count + 1);
    const struct world_light found = pose_light(&pose, copy->light_count - 1);
    CHECK(memcmp(&found.intensity, &sun.intensity, sizeof sun.intensity) == 0);
    CHECK_NEAR(glms_vec3_dot(found.direction, sun.direction), 1, 1e-6);
    pose_finish(&pose);
    scene_destroy(copy);
    scene_destroy(scene);
}

// ---- files

#define LAMP                                                                                       \
    "{" ASSET ",'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':"     \
    "{'lights':[{'type':'point'}]}},'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}}]}"

TEST(a_file_gets_the_environment_that_the_scene_has)
{
    struct scene *scene = load_gltf(LAMP, NULL, 0);
    assert_non_null(scene);
    light_by_sky(scene);
    struct scene *copy = copy_of_file(scene, "copy.glb");
    check_environment(scene, copy);
    scene_set_environment_map(copy, copy->environment.map, 0.25f, -1.0f);
    struct scene *turned = copy_of_file(copy, "turned.glb");
    check_environment(copy, turned);
    scene_set_environment_map(turned, NULL, 1.0f, 0.0f);
    struct scene *none = copy_of_file(turned, "none.glb");
    CHECK(!none->environment.map && none->light_count == 1);
    scene_destroy(none);
    scene_destroy(turned);
    scene_destroy(copy);
    scene_destroy(scene);
}

TEST(an_image_based_light_stays_in_the_file_until_another_replaces_it)
{
    struct made_faces made = { 0 };
    struct gltf_doc doc;
    bool same;
    quadrants(&made, 100);
    struct scene *scene = load_light(&made, ALL_FACES, ",'intensity':2,'rotation':[0,0.6,0,0.8]");
    assert_non_null(scene);
    CHECK(gltf_doc_of_file(&doc, test_host(), scene, &same) && same);
    const json_t *first = json_array_get(json_object_get(doc.root, "scenes"), 0);
    CHECK(json_object_get(json_object_get(first, "extensions"), "EXT_lights_image_based"));
    CHECK(!json_object_get(first, "extras"));
    struct scene *copy = written(&doc, "copy.glb");
    check_environment(scene, copy);
    light_by_sky(scene);
    struct scene *replaced = copy_of_file(scene, "replaced.glb");
    check_environment(scene, replaced);
    scene_destroy(replaced);
    scene_destroy(copy);
    scene_destroy(scene);
}

// ---- damaged files

static json_t *environment_of(struct gltf_doc *doc)
{
    json_t *scene = json_array_get(json_object_get(doc->root, "scenes"), 0);
    return json_object_get(json_object_get(scene, "extras"), "afterglow_environment");
}

struct damage {
    const char *key, *json, *message;
};

static void check_damage(const struct scene *scene, const struct damage *damage)
{
    struct gltf_doc doc;
    CHECK(gltf_doc_of_scene(&doc, test_host(), scene));
    json_t *value = json_loads(damage->json, JSON_DECODE_ANY, NULL);
    CHECK(value && json_object_set_new(environment_of(&doc), damage->key, value) == 0);
    CHECK(gltf_doc_write(&doc, test_path("damaged.glb")));
    gltf_doc_finish(&doc);
    test_forget_messages();
    struct scene *copy = scene_load(test_host(), test_path("damaged.glb"));
    if (copy || !strstr(test_last_message(), damage->message))
        fail_msg("%s %s: %s", damage->key, damage->json, test_last_message());
}

TEST(damaged_environments_are_refused)
{
    static const struct damage damages[] = {
        { "bufferView", "1000", "does not exist" },
        { "bufferView", "\"x\"", "is not an index" },
        { "bufferView", "0", "not an OpenEXR file" },
        { "strength", "-1", "strength" },
        { "strength", "1e9", "strength" },
        { "rotation", "[1]", "rotation" },
        { "sun", "3", "sun is not an object" },
        { "sun", "{}", "its sun has no direction" },
        { "sun", "{\"direction\":[0,2,0],\"illuminance\":[1,1,1]}", "not a unit vector" },
        { "sun", "{\"direction\":[0,1,0],\"illuminance\":[1,-1,1]}", "is negative" },
        { "sun", "{\"direction\":[0,1,0],\"illuminance\":[1e30,1,1]}", "the environment" },
    };
    struct scene *scene = scene_load(test_host(), "@cornell:light=point");
    assert_non_null(scene);
    light_by_sky(scene);
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) check_damage(scene, &damages[i]);
    scene_destroy(scene);
}
