// A bake has a part for each mesh, which does not depend on the scene: files of parts serve in all
// scenes that have the mesh.
#include "framework/test.h"
#include "techniques/dnrt/sphere_fixture.h"
#include "techniques/gi_bake.h"
#include "techniques/gi_spec.h"

#include "core/files/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OPTIONS "size=16,rays=16"
enum { SAMPLES = 16 * 16 * 16, RAYS = 16 };

struct objects_scene {
    struct scene *scene;
    struct scene_pose pose;
    struct gi_spec spec;
    struct technique_bake how;
    struct bake *bake;
};

static void open_scene(struct objects_scene *s)
{
    *s = (struct objects_scene){ .scene = scene_create(test_host(), "test") };
}

static int add_material(struct objects_scene *s, vec3s albedo)
{
    struct material material = material_default();
    material.base_color = vec4_of(albedo, 1);
    return scene_add_material(s->scene, &material);
}

// About an axis that is no axis of the mesh.
static void place(struct objects_scene *s, int mesh, vec3s at, float turn, float scale,
                  bool movable)
{
    struct node node = node_default();
    node.translation = at;
    node.rotation = glms_quatv(turn, glms_vec3_normalize(vec3_of(1, 2, 0.5f)));
    node.scale = vec3_of(scale, scale, scale);
    const struct instance it = {
        .node = scene_add_node(s->scene, &node), .mesh = mesh, .skin = -1, .movable = movable
    };
    CHECK(scene_add_instance(s->scene, &it) >= 0);
}

static void plan_bake(struct objects_scene *s, const char *options, bool all)
{
    char text[128];
    const struct bake_identity identity = { .program = "" };
    snprintf(text, sizeof text, "lpv+dnrt:%s", options);
    CHECK(pose_init(&s->pose, s->scene, -1, 0));
    CHECK(gi_spec_parse(&s->spec, test_host(), text));
    s->how = (struct technique_bake){ .pose = &s->pose,
                                      .options = s->spec.options[1],
                                      .all_objects = all };
    s->bake = gi_bake_create(test_host(), s->spec.technique[1], &s->how, identity);
    assert_non_null(s->bake);
}

static void close_scene(struct objects_scene *s)
{
    bake_destroy(s->bake);
    gi_spec_finish(&s->spec);
    pose_finish(&s->pose);
    scene_destroy(s->scene);
}

static const vec3s RED = { { 0.9f, 0.2f, 0.1f } }, BLUE = { { 0.2f, 0.4f, 0.9f } };

// A blue ball alone.
static void open_ball(struct objects_scene *s, const char *options)
{
    open_scene(s);
    place(s, sphere_fixture_add(s->scene, add_material(s, BLUE)), vec3_of(0, 0, 0), 0, 1, true);
    plan_bake(s, options, false);
}

// A red crate, then the same ball: elsewhere, turned, larger, its material and mesh of other
// numbers.
static void open_pair(struct objects_scene *s, const char *options)
{
    open_scene(s);
    place(s, crate_fixture_add(s->scene, add_material(s, RED)), vec3_of(0, 0, 0), 0, 1, true);
    place(s, sphere_fixture_add(s->scene, add_material(s, BLUE)), vec3_of(3, 1, -2), 0.7f, 2.5f,
          true);
    plan_bake(s, options, false);
}

static double rays_left(struct bake *bake)
{
    struct bake_estimate estimate;
    CHECK(bake_estimate(bake, &(struct bake_run_options){ .threads = 1 }, false, &estimate));
    return estimate.rays;
}

static void run(struct bake *bake)
{
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 2 }) && bake_is_complete(bake));
}

static void check_same_files(const char *a, const char *b)
{
    struct file_bytes left, right;
    CHECK(file_read(test_host(), a, SIZE_MAX, &left));
    CHECK(file_read(test_host(), b, SIZE_MAX, &right));
    CHECK(left.size == right.size && memcmp(left.data, right.data, left.size) == 0);
    file_bytes_finish(test_host(), &left);
    file_bytes_finish(test_host(), &right);
}

// test_path has one buffer.
static void path_of(const char *name, char out[512])
{
    snprintf(out, 512, "%s", test_path(name));
}

// The part of the pair that is the ball.
static int find_ball(const struct objects_scene *ball, const struct objects_scene *pair)
{
    char wanted[HASH128_TEXT], key[HASH128_TEXT];
    bake_part_key(ball->bake, 0, wanted);
    assert_int_equal(bake_part_count(pair->bake), 2);
    for (int part = 0; part < 2; part++) {
        bake_part_key(pair->bake, part, key);
        if (strcmp(key, wanted) == 0) return part;
    }
    fail_msg("the ball of two scenes has two keys");
    return -1;
}

static void check_sharing(const char *options)
{
    struct objects_scene ball, pair, again;
    char alone[512], part_file[512], whole[512], loaded[512];
    path_of("alone.safetensors", alone);
    path_of("part.safetensors", part_file);
    path_of("whole.safetensors", whole);
    path_of("loaded.safetensors", loaded);
    open_ball(&ball, options);
    open_pair(&pair, options);
    const int part = find_ball(&ball, &pair);
    run(ball.bake);
    run(pair.bake);
    CHECK(bake_save(ball.bake, alone, false) && bake_save(pair.bake, whole, false));
    CHECK(bake_save_part(pair.bake, part, part_file, false));
    check_same_files(alone, part_file);
    CHECK(bake_fits(pair.bake, ball.bake) && !bake_fits(ball.bake, pair.bake));

    // With the ball's file the other part alone is run, to the same bytes.
    open_pair(&again, options);
    const double rays = rays_left(again.bake);
    CHECK(!bake_load_part(again.bake, 1 - part, alone));
    CHECK(strstr(test_last_message(), "of another object"));
    CHECK(bake_load_part(again.bake, part, alone));
    CHECK(bake_part_is_loaded(again.bake, part) && !bake_is_complete(again.bake));
    CHECK(rays_left(again.bake) < rays && rays_left(again.bake) > 0);
    run(again.bake);
    CHECK(bake_save(again.bake, loaded, false));
    check_same_files(whole, loaded);
    close_scene(&again);
    close_scene(&pair);
    close_scene(&ball);
}

TEST(a_mesh_has_one_file_in_all_scenes)
{
    check_sharing(OPTIONS);
    check_sharing(OPTIONS ",self=true,direct=true");
}

// The tasks of the crate alone, before and after its last wave.
TEST(a_checkpoint_beside_a_loaded_part_is_resumed)
{
    struct objects_scene ball, pair, again;
    char alone[512], whole[512], partial[512], resumed[512];
    path_of("alone.safetensors", alone);
    path_of("whole.safetensors", whole);
    path_of("partial.safetensors", partial);
    path_of("resumed.safetensors", resumed);
    open_ball(&ball, OPTIONS ",self=true");
    run(ball.bake);
    CHECK(bake_save(ball.bake, alone, false));
    for (int complete = 0; complete < 2; complete++) {
        const struct bake_run_options one = { .threads = 1 };
        struct bake_estimate estimate;
        open_pair(&pair, OPTIONS ",self=true");
        const int part = find_ball(&ball, &pair);
        CHECK(bake_load_part(pair.bake, part, alone));
        CHECK(complete ? bake_run(pair.bake, &one)
                       : bake_estimate(pair.bake, &one, true, &estimate));
        CHECK(bake_is_complete(pair.bake) == (complete == 1));
        CHECK(bake_save_partial(pair.bake, partial));
        open_pair(&again, OPTIONS ",self=true");
        CHECK(bake_load_part(again.bake, part, alone) && bake_merge(again.bake, partial));
        CHECK(bake_is_complete(again.bake) == (complete == 1));
        run(again.bake);
        run(pair.bake);
        CHECK(bake_save(pair.bake, whole, false) && bake_save(again.bake, resumed, false));
        check_same_files(whole, resumed);
        close_scene(&again);
        close_scene(&pair);
    }
    // Without the part, tasks of the crate's last wave are before those of the ball's first.
    open_pair(&pair, OPTIONS ",self=true");
    CHECK(!bake_merge(pair.bake, partial) && strstr(test_last_message(), "order of its stages"));
    close_scene(&pair);
    close_scene(&ball);
}

TEST(a_file_of_a_scene_serves_another_one_for_what_both_have)
{
    struct objects_scene ball, pair;
    char alone[512], whole[512];
    path_of("alone.safetensors", alone);
    path_of("whole.safetensors", whole);
    open_ball(&ball, OPTIONS);
    run(ball.bake);
    CHECK(bake_save(ball.bake, alone, false));
    close_scene(&ball);

    open_pair(&pair, OPTIONS);
    CHECK(!bake_load(pair.bake, alone));
    CHECK(strstr(test_last_message(), "of the scene's 2 objects, 1 are in no file"));
    CHECK(rays_left(pair.bake) == (double)SAMPLES * RAYS);
    run(pair.bake);
    CHECK(bake_save(pair.bake, whole, false));
    close_scene(&pair);

    // One that has more.
    open_ball(&ball, OPTIONS);
    CHECK(bake_load(ball.bake, whole) && bake_is_complete(ball.bake));
    close_scene(&ball);
}

// Two meshes of equal content.
TEST(equal_meshes_are_baked_once)
{
    struct objects_scene s;
    open_scene(&s);
    for (int i = 0; i < 2; i++)
        place(&s, sphere_fixture_add(s.scene, add_material(&s, BLUE)), vec3_of(3 * (float)i, 0, 0),
              0.4f * (float)i, 1, true);
    plan_bake(&s, OPTIONS, false);
    CHECK(s.scene->mesh_count == 2 && bake_part_count(s.bake) == 1);
    CHECK(rays_left(s.bake) == (double)SAMPLES * RAYS);
    close_scene(&s);
}

TEST(a_part_depends_on_shape_material_and_stretch)
{
    char key[4][HASH128_TEXT];
    for (int i = 0; i < 4; i++) {
        struct objects_scene s;
        open_scene(&s);
        const int material = add_material(&s, i == 1 ? RED : BLUE);
        place(&s,
              i == 2 ? crate_fixture_add(s.scene, material) : sphere_fixture_add(s.scene, material),
              vec3_of(0, 0, 0), 0, 1, true);
        if (i == 3) s.scene->nodes[s.scene->instances[0].node].scale.y = 1.5f;
        plan_bake(&s, OPTIONS, false);
        bake_part_key(s.bake, 0, key[i]);
        for (int k = 0; k < i; k++) CHECK(strcmp(key[k], key[i]) != 0);
        close_scene(&s);
    }
}

TEST(an_asset_is_baked_as_the_objects_that_it_will_be)
{
    struct objects_scene ball, asset;
    char of_ball[HASH128_TEXT], of_asset[HASH128_TEXT];
    open_ball(&ball, OPTIONS);
    open_scene(&asset);
    place(&asset, sphere_fixture_add(asset.scene, add_material(&asset, BLUE)), vec3_of(0, 2, 0), 1,
          1, false);
    plan_bake(&asset, OPTIONS, true);
    bake_part_key(ball.bake, 0, of_ball);
    bake_part_key(asset.bake, 0, of_asset);
    CHECK_STRING(of_ball, of_asset);
    close_scene(&asset);
    close_scene(&ball);
}

TEST(a_damaged_part_is_refused)
{
    struct objects_scene ball;
    struct file_bytes bytes;
    char path[512];
    path_of("damaged.safetensors", path);
    open_ball(&ball, OPTIONS);
    run(ball.bake);
    CHECK(bake_save_part(ball.bake, 0, path, false));
    close_scene(&ball);
    CHECK(file_read(test_host(), path, SIZE_MAX, &bytes));
    ((uint8_t *)bytes.data)[bytes.size - 1] ^= 1;
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(bytes.data, 1, bytes.size, file) == bytes.size && fclose(file) == 0);
    file_bytes_finish(test_host(), &bytes);
    open_ball(&ball, OPTIONS);
    CHECK(!bake_load_part(ball.bake, 0, path) && strstr(test_last_message(), "damaged"));
    CHECK(!bake_part_is_complete(ball.bake, 0));
    close_scene(&ball);
}
