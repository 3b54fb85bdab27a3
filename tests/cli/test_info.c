// info and list: their output can be parsed.
#include "cli/program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static double number(const json_t *document, const char *key)
{
    const json_t *value = json_object_get(document, key);
    if (!json_is_number(value)) fail_msg("no number %s", key);
    return json_number_value(value);
}

static const char *text(const json_t *document, const char *key)
{
    const json_t *value = json_object_get(document, key);
    if (!json_is_string(value)) fail_msg("no text %s", key);
    return json_string_value(value);
}

TEST(links_out_of_the_folder_of_a_scene_are_followed_on_request)
{
    static const char obj[] = "mtllib made.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\nusemtl red\nf 1 2 3\n";
    char path[600];
    snprintf(path, sizeof path, "%s/made.obj", make_folder("linked"));
    write_file(path, obj, sizeof obj - 1);
    write_file(test_path("outside.mtl"), "newmtl red\n", 11);
    assert_int_equal(symlink("../outside.mtl", test_path("linked/made.mtl")), 0);
    const struct run *refused = run_expect(1, "info", path, NULL);
    check_one_error_line(refused);
    CHECK(strstr(refused->err, "refers to made.mtl") && strstr(refused->err, "--follow-links"));
    run_expect(0, "info --follow-links", path, NULL);
}

TEST(info_of_the_cornell_box_is_its_published_size)
{
    json_t *info = run_json(run_expect(0, "info @cornell --json", NULL));
    const json_t *low = json_object_get(json_object_get(info, "bounds"), "min");
    const json_t *high = json_object_get(json_object_get(info, "bounds"), "max");
    double width =
        json_number_value(json_array_get(high, 0)) - json_number_value(json_array_get(low, 0));
    CHECK_NEAR(width, 5.56, 1e-3);
    CHECK(number(info, "triangles") >= 20);
    CHECK(number(info, "memory_bytes") > 0);
    CHECK(json_is_true(json_object_get(info, "emissive")));
    assert_int_equal(json_array_size(json_object_get(info, "cameras")), 1);
    CHECK_STRING(text(json_array_get(json_object_get(info, "cameras"), 0), "name"), "main");
    const json_t *defaults = json_object_get(info, "defaults");
    CHECK(json_is_null(json_object_get(defaults, "light")));
    CHECK(json_is_null(json_object_get(defaults, "camera")));
    json_decref(info);
}

// The file is a block map, which makes the same file.
TEST(info_writes_the_block_map_of_a_scene)
{
    char path[600], again[600], gi[700];
    snprintf(path, sizeof path, "%s", test_path("blocks.json"));
    snprintf(again, sizeof again, "%s", test_path("again.json"));
    run_expect(0, "info @maze --blocks", path, NULL);
    json_t *map = json_load_file(path, 0, NULL);
    const json_t *blocks = json_object_get(map, "blocks");
    CHECK(json_integer_value(json_object_get(map, "afterglow_block_map")) == 1);
    CHECK(json_array_size(blocks) > 4);
    CHECK(json_object_size(json_object_get(json_array_get(blocks, 0), "neighbors")) > 0);
    json_decref(map);
    snprintf(gi, sizeof gi, "drt:blocks=%s", path);
    run_expect(0, "info @maze --gi", gi, "--blocks", again, NULL);
    CHECK(files_are_equal(path, again));
    const struct run *r = run_expect(2, "info @maze --gi lpv --blocks", again, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "mrt, drt") && files_are_equal(path, again));
    r = run_expect(2, "info @maze --gi mrt", NULL);
    CHECK(strstr(r->err, "--blocks"));
}

TEST(info_lists_as_many_things_as_it_counts)
{
    const struct run *r = run_expect(0, "info @cornell:light=point --json", NULL);
    json_t *info = run_json(r);
    assert_int_equal(json_array_size(json_object_get(info, "lights")), 1);
    const json_t *light = json_array_get(json_object_get(info, "lights"), 0);
    CHECK_STRING(text(light, "type"), "point");
    CHECK_STRING(text(light, "unit"), "cd");
    assert_int_equal(json_array_size(json_object_get(light, "position")), 3);
    CHECK(json_array_size(json_object_get(info, "materials")) >= 3);
    assert_int_equal(json_array_size(json_object_get(info, "animations")), 0);
    json_decref(info);
    CHECK(strstr(run_expect(0, "info @cornell:light=point", NULL)->out, "lights       1\n"));
}

// A square floor and a wall, in a format without lights and cameras.
static const char *write_dark_scene(void)
{
    static const char obj[] = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\n"
                              "f 1 4 3\nf 1 3 2\nf 1 2 6\nf 1 6 5\n";
    const char *path = test_path("dark.obj");
    write_file(path, obj, sizeof obj - 1);
    return path;
}

TEST(a_dark_scene_shows_the_options_of_its_defaults)
{
    json_t *info = run_json(run_expect(0, "info --json", write_dark_scene(), NULL));
    const json_t *defaults = json_object_get(info, "defaults");
    const json_t *light = json_object_get(defaults, "light");
    const json_t *camera = json_object_get(defaults, "camera");
    CHECK(strncmp(text(light, "light"), "sun:", 4) == 0);
    float v[3];
    CHECK(sscanf(text(light, "sky"), "%f,%f,%f", &v[0], &v[1], &v[2]) == 3 && v[0] > 0);
    CHECK(sscanf(text(camera, "eye"), "%f,%f,%f", &v[0], &v[1], &v[2]) == 3 && isfinite(v[0]));
    json_decref(info);
    const struct run *r = run_expect(0, "info", test_path("dark.obj"), NULL);
    CHECK(strstr(r->out, "--light sun:") && strstr(r->out, "--eye "));
    CHECK_STRING(r->err, "");
}

TEST(time_moves_the_bounds_of_an_animated_scene)
{
    const char *scene = test_scene_path("box-animated.gltf");
    char bounds[2][256];
    CHECK(strstr(run_expect(0, "info --animation 0", scene, NULL)->out, "animations   1\n"));
    const char *times[2] = { "0", "1.5" };
    for (int i = 0; i < 2; i++) {
        json_t *info = run_json(run_expect(0, "info --json --time", times[i], scene, NULL));
        char *dump = json_dumps(json_object_get(info, "bounds"), JSON_COMPACT);
        snprintf(bounds[i], sizeof bounds[i], "%s", dump);
        free(dump);
        json_decref(info);
    }
    assert_string_not_equal(bounds[0], bounds[1]);
    check_one_error_line(run_expect(1, "info --animation 7", scene, NULL));
}

TEST(list_names_every_technique_scene_and_layer)
{
    json_t *list = run_json(run_expect(0, "list --json --quiet", NULL));
    bool has_none = false, has_cornell = false;
    int experts = 0;
    json_t *item, *option;
    size_t i, k;
    json_array_foreach(json_object_get(list, "techniques"), i, item)
    {
        has_none |= strcmp(text(item, "name"), "none") == 0;
        json_array_foreach(json_object_get(item, "options"), k, option)
        {
            CHECK(text(option, "help")[0] && text(option, "name")[0]);
            CHECK(json_object_get(option, "default"));
            CHECK(json_is_boolean(json_object_get(option, "expert")));
            experts += json_is_true(json_object_get(option, "expert"));
            if (strcmp(text(option, "type"), "int") == 0 ||
                strcmp(text(option, "type"), "float") == 0)
                CHECK(number(option, "min") <= number(option, "max"));
            if (strcmp(text(option, "type"), "choice") == 0)
                CHECK(json_array_size(json_object_get(option, "choices")) >= 2);
        }
    }
    json_array_foreach(json_object_get(list, "scenes"), i, item) has_cornell |=
        strcmp(text(item, "name"), "@cornell") == 0;
    CHECK(has_none && has_cornell && experts > 20);
    CHECK(json_array_size(json_object_get(list, "layers")) >= 10);
    CHECK(json_is_array(json_object_get(list, "devices")));
    CHECK(json_array_size(json_object_get(list, "frame_options")) >= 1);
    json_decref(list);
    const char *out = run_expect(0, "list --quiet", NULL)->out;
    CHECK(strstr(out, "Techniques") && strstr(out, "@cornell") && strstr(out, "lpv"));
}

TEST(options_for_experts_are_listed_with_all_and_counted_without)
{
    static const char *const commands[] = { "list radiosity", "list --quiet" };
    for (int i = 0; i < 2; i++) {
        char all[64];
        snprintf(all, sizeof all, "%s --all", commands[i]);
        const char *out = run_expect(0, commands[i], NULL)->out;
        CHECK(strstr(out, "    texels=") && !strstr(out, "    seams="));
        CHECK(strstr(out, "    and 3 for experts: afterglow list radiosity --all\n"));
        out = run_expect(0, all, NULL)->out;
        CHECK(!strstr(out, "for experts"));
        CHECK(strstr(out, "    texels=") && strstr(out, "    texels=") < strstr(out, "    seams="));
    }
    json_t *technique = run_json(run_expect(0, "list radiosity --json", NULL));
    json_t *option;
    size_t i;
    json_array_foreach(json_object_get(technique, "options"), i, option)
        CHECK(json_is_true(json_object_get(option, "expert")) ==
              (strcmp(text(option, "name"), "seams") == 0 ||
               strcmp(text(option, "name"), "smooth") == 0 ||
               strcmp(text(option, "name"), "cluster") == 0));
    json_decref(technique);
}
