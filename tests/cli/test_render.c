// render: reproducible, layers add up, options work, failures leave no file.
#include "cli/program.h"

#include "image/exr.h"
#include "image/png_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char SMALL[] = "render @cornell:light=point --size 48x32 --quiet";

static struct image read_layer(const char *path, const char *layer)
{
    struct image image = { 0 };
    if (!exr_read(test_host(), path, layer, &image)) fail_msg("%s", test_last_message());
    return image;
}

static double mean(const struct image *image)
{
    double sum = 0;
    int count = image->width * image->height * image->channels;
    for (int i = 0; i < count; i++) sum += (double)image->pixels[i];
    return sum / count;
}

static double mean_of(const char *path, const char *layer)
{
    struct image image = read_layer(path, layer);
    double value = mean(&image);
    image_finish(&image, test_host());
    return value;
}

TEST(equal_commands_write_equal_files)
{
    require_device();
    static const char *const names[] = { "x.png", "x.exr" };
    char a[300], b[300], words[300];
    snprintf(words, sizeof words, "%s --gi lpv --frames 2 -o", SMALL);
    for (int i = 0; i < 2; i++) {
        snprintf(a, sizeof a, "%s", test_path(names[i]));
        snprintf(b, sizeof b, "%s/%s", make_folder(i ? "second-exr" : "second-png"), names[i]);
        const struct run *r = run_expect(0, words, a, NULL);
        CHECK_STRING(r->err, "");
        CHECK_STRING(r->out, "");
        run_expect(0, words, b, NULL);
        CHECK(files_are_equal(a, b));
    }
}

TEST(an_empty_scene_has_nothing_to_see)
{
    require_device();
    static const char empty[] = "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{}],\"scene\":0}";
    char scene[300];
    snprintf(scene, sizeof scene, "%s", test_path("empty.gltf"));
    write_file(scene, empty, sizeof empty - 1);
    const struct run *r =
        run_expect(0, "render", scene, "--size", "16x16", "-o", test_path("empty.png"), NULL);
    CHECK(strstr(r->err, "nothing to see in ") && strstr(r->err, "it has no triangles"));
}

TEST(a_view_without_light_is_said_to_be_black)
{
    require_device();
    const struct run *r =
        run_expect(0, "render", "@cornell:light=point", "--no-scene-lights", "--size", "16x16",
                   "--gi", "lpv", "-o", test_path("black.png"), NULL);
    CHECK(strstr(r->err, "the image is black") && strstr(r->err, "try --sky"));
    r = run_expect(0, "render", "@cornell:light=point", "--size", "16x16", "-o",
                   test_path("lit.png"), NULL);
    CHECK(!strstr(r->err, "black"));
}

TEST(a_time_of_a_scene_without_animation_is_said_to_have_no_effect)
{
    require_device();
    const struct run *r = run_expect(0, "render", "@cornell:light=point", "--time", "1", "--size",
                                     "16x16", "-o", test_path("time.png"), NULL);
    CHECK(strstr(r->err, "--time has no effect: @cornell:light=point has no animation"));
}

TEST(visibility_alone_stands_on_ambient_and_says_so)
{
    require_device();
    char alone[300], both[300];
    const char *words = "render @cornell:light=point --size 48x32 -o";
    snprintf(alone, sizeof alone, "%s", test_path("alone.exr"));
    snprintf(both, sizeof both, "%s/alone.exr", make_folder("ambient-vo"));
    CHECK(strstr(run_expect(0, words, alone, "--gi", "vo", NULL)->err, "using ambient+vo"));
    CHECK_STRING(run_expect(0, words, both, "--gi", "ambient+vo", NULL)->err, "");
    CHECK(files_are_equal(alone, both));
    CHECK_STRING(run_expect(0, words, both, "--gi", "none+vo", NULL)->err, "");
    CHECK(!files_are_equal(alone, both));
}

TEST(one_frame_of_a_history_is_said_to_have_noise)
{
    require_device();
    const char *words = "render @cornell:light=point --size 48x32 -o";
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("noise.png"));
    const struct run *r = run_expect(0, words, path, "--gi", "vct:resolution=16", NULL);
    CHECK(strstr(r->err, "vct:resolution=16 accumulates over frames; try --frames 16"));
    r = run_expect(0, words, path, "--gi", "vct:resolution=16", "--frames", "2", NULL);
    CHECK_STRING(r->err, "");
    r = run_expect(0, words, path, "--gi", "vct:resolution=16,temporal=false", NULL);
    CHECK_STRING(r->err, "");
}

TEST(direct_and_indirect_light_add_up_to_colour)
{
    require_device();
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("layers.exr"));
    run_expect(0, SMALL, "--gi", "lpv", "--aov", "color,direct,indirect,depth,visibility", "-o",
               path, NULL);
    struct image color = read_layer(path, NULL), direct = read_layer(path, "direct"),
                 indirect = read_layer(path, "indirect"), depth = read_layer(path, "depth");
    assert_int_equal(depth.channels, 1);
    CHECK(mean(&indirect) > 0 && mean(&direct) > 0);
    double scale = mean(&color);
    for (int i = 0; i < color.width * color.height * 3; i++) {
        double sum = (double)direct.pixels[i] + (double)indirect.pixels[i];
        // Half floats on the GPU: 11 bits each.
        CHECK_NEAR(sum, color.pixels[i], 2e-3 * fabs(sum) + 1e-4 * scale);
    }
    image_finish(&color, test_host());
    image_finish(&direct, test_host());
    image_finish(&indirect, test_host());
    image_finish(&depth, test_host());
}

TEST(an_exr_records_how_it_was_made)
{
    require_device();
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("attributes.exr"));
    run_expect(0, SMALL, "--gi", "lpv:steps=3", "--exposure", "7.5", "--seed", "42", "-o", path,
               NULL);
    static const char *const expected[][2] = { { "afterglow.scene", "@cornell:light=point" },
                                               { "afterglow.camera", "main" },
                                               { "afterglow.exposure_ev", "7.5" },
                                               { "afterglow.seed", "42" } };
    for (size_t i = 0; i < 4; i++) {
        char *value = exr_attribute_value(test_host(), path, expected[i][0]);
        assert_non_null(value);
        CHECK_STRING(value, expected[i][1]);
        host_free(test_host(), value);
    }
    char *gi = exr_attribute_value(test_host(), path, "afterglow.gi");
    assert_non_null(gi);
    CHECK(strstr(gi, "lpv:") && strstr(gi, "steps=3"));
    host_free(test_host(), gi);
}

TEST(light_options_add_and_remove_light)
{
    require_device();
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("light.exr"));
    run_expect(0, SMALL, "--no-scene-lights", "-o", path, NULL);
    CHECK(mean_of(path, NULL) == 0.0);
    run_expect(0, SMALL, "--no-scene-lights", "--light", "point:0,2.7,0:100,100,100", "-o", path,
               NULL);
    double once = mean_of(path, NULL);
    run_expect(0, SMALL, "--no-scene-lights", "--light", "point:0,2.7,0:100,100,100", "--light",
               "point:0,2.7,0:100,100,100", "-o", path, NULL);
    CHECK(once > 0);
    CHECK_RELATIVE(mean_of(path, NULL), 2 * once, 2e-3);
    // Light of an area light on other surfaces comes from techniques; direct light shows only the
    // rectangle.
    run_expect(0, SMALL, "--no-scene-lights", "--light", "area:0,3,-2:0,0,1:1,1:100,100,100",
               "--gi", "ambient", "--aov", "color,direct,indirect", "-o", path, NULL);
    CHECK(mean_of(path, "direct") > 0 && mean_of(path, "indirect") > 0);
}

TEST(a_technique_logs_how_it_handles_a_scene)
{
    require_device();
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("diagnostics.png"));
    const struct run *r = run_expect(0,
                                     "render @cornell:light=point --size 16x16 --gi lpv --verbose "
                                     "--light point:90,0,0:1,1,1 -o",
                                     path, NULL);
    CHECK(strstr(r->err, "cells of 0."));
    CHECK(strstr(r->err, "light 1 of @cornell:light=point is outside of the grid"));
}

TEST(the_sky_is_visible_where_there_is_no_surface)
{
    require_device();
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("sky.exr"));
    run_expect(0, SMALL, "--no-scene-lights", "--sky", "3,5,7", "--eye", "0,2,50", "--target",
               "0,2,100", "-o", path, NULL);
    struct image image = read_layer(path, NULL);
    for (int c = 0; c < 3; c++) CHECK_RELATIVE(image.pixels[c], 3 + 2 * c, 2e-3);
    image_finish(&image, test_host());
}

TEST(a_brighter_exposure_is_a_brighter_png_and_the_same_exr)
{
    require_device();
    struct image images[2] = { 0 };
    char path[300], exr[2][300];
    snprintf(path, sizeof path, "%s", test_path("ev.png"));
    for (int i = 0; i < 2; i++) {
        const char *ev = i ? "4" : "6";
        snprintf(exr[i], sizeof exr[i], "%s", test_path(i ? "ev4.exr" : "ev6.exr"));
        run_expect(0, SMALL, "--exposure", ev, "-o", path, NULL);
        run_expect(0, SMALL, "--exposure", ev, "-o", exr[i], NULL);
        assert_true(png_read(test_host(), path, &images[i]));
    }
    CHECK(mean(&images[1]) > 1.2 * mean(&images[0]));
    CHECK_NEAR(mean_of(exr[0], NULL), mean_of(exr[1], NULL), 0);
    for (int i = 0; i < 2; i++) image_finish(&images[i], test_host());
}

// A scene without light and camera, and the notes about its defaults.
TEST(the_printed_defaults_give_the_same_image)
{
    require_device();
    static const char obj[] = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\n"
                              "f 1 4 3\nf 1 3 2\nf 1 2 6\nf 1 6 5\n";
    char scene[300], first[300], again[300], light[256], sky[128], eye[128], target[128], fov[64];
    snprintf(scene, sizeof scene, "%s", test_path("dark.obj"));
    snprintf(first, sizeof first, "%s", test_path("default.exr"));
    snprintf(again, sizeof again, "%s", test_path("asked.exr"));
    write_file(scene, obj, sizeof obj - 1);
    const struct run *r = run_expect(0, "render --size 32x32 --gi lpv -o", first, scene, NULL);
    const char *said_light = strstr(r->err, "--light "), *said_eye = strstr(r->err, "--eye ");
    CHECK(said_light && said_eye);
    assert_int_equal(sscanf(said_light, "--light %255s --sky %127s", light, sky), 2);
    assert_int_equal(sscanf(said_eye, "--eye %127s --target %127s --fov %63s", eye, target, fov),
                     3);
    r = run_expect(0, "render --size 32x32 --gi lpv --light", light, "--sky", sky, "--eye", eye,
                   "--target", target, "--fov", fov, "-o", again, scene, NULL);
    CHECK_STRING(r->err, "");
    CHECK(files_are_equal(first, again));
    CHECK(mean_of(first, NULL) > 0);
}

TEST(a_scene_lit_only_by_emission_causes_a_warning)
{
    require_device();
    const char *path = test_path("emitter.png");
    CHECK(strstr(run_expect(0, "render @cornell --size 16x16 -o", path, NULL)->err, "--gi lpv"));
    CHECK_STRING(run_expect(0, "render @cornell --gi lpv --size 16x16 -o", path, NULL)->err, "");
    CHECK_STRING(run_expect(0, "render @cornell:light=point --size 16x16 -o", path, NULL)->err, "");
}

TEST(a_number_in_the_name_writes_every_frame_and_time_moves)
{
    require_device();
    const char *scene = test_scene_path("box-animated.gltf");
    char pattern[300], frames[3][300];
    snprintf(pattern, sizeof pattern, "%s", test_path("frame-%03d.exr"));
    for (int i = 0; i < 3; i++) {
        char name[32];
        snprintf(name, sizeof name, "frame-%03d.exr", i);
        snprintf(frames[i], sizeof frames[i], "%s", test_path(name));
    }
    run_expect(0, "render --size 32x32 --quiet --frames 2 --time-step 0.75 -o", pattern, scene,
               NULL);
    CHECK(file_exists(frames[0]) && file_exists(frames[1]) && !file_exists(frames[2]));
    CHECK(!files_are_equal(frames[0], frames[1]));
    run_expect(0, "render --size 32x32 --quiet --frames 2 -o", pattern, scene, NULL);
    CHECK_NEAR(mean_of(frames[0], NULL), mean_of(frames[1], NULL), 0);
}

// The scene has a moving box and a static one.
TEST(motion_is_that_of_moving_objects_from_the_second_frame_on)
{
    require_device();
    const char *scene = test_scene_path("box-animated.gltf");
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("motion.exr"));
    for (int frames = 1; frames <= 2; frames++) {
        const char *words = frames == 1 ? "render --size 32x32 --quiet --aov motion,depth -o"
                                        : "render --size 32x32 --quiet --aov motion,depth "
                                          "--time 1 --frames 2 --time-step 0.25 -o";
        run_expect(0, words, path, scene, NULL);
        struct image motion = read_layer(path, "motion"), depth = read_layer(path, "depth");
        int moving = 0, still = 0;
        for (int i = 0; i < 32 * 32; i++) {
            const float *m = &motion.pixels[3 * i];
            const bool moves = m[0] != 0.0f || m[1] != 0.0f || m[2] != 0.0f;
            CHECK(fabsf(m[0]) < 0.2f && fabsf(m[1]) < 0.2f && fabsf(m[2]) < 0.2f);
            CHECK(!moves || depth.pixels[i] > 0.0f);
            moving += moves;
            still += !moves && depth.pixels[i] > 0.0f;
        }
        if (frames == 1) CHECK(moving == 0);
        if (frames == 2) CHECK(moving > 20 && still > 20);
        image_finish(&motion, test_host());
        image_finish(&depth, test_host());
    }
}

// The box has one colour for each instance and triangle: pixels of equal ids have equal colours.
TEST(ids_are_exact_in_an_exr_and_colours_in_a_png)
{
    require_device();
    char exr[300], png[300];
    struct image shown = { 0 };
    snprintf(exr, sizeof exr, "%s", test_path("id.exr"));
    snprintf(png, sizeof png, "%s", test_path("id.png"));
    run_expect(0, SMALL, "--aov", "id,depth", "-o", exr, NULL);
    run_expect(0, SMALL, "--aov", "id", "-o", png, NULL);
    struct image ids = read_layer(exr, "id"), depth = read_layer(exr, "depth");
    assert_true(png_read(test_host(), png, &shown));
    assert_true(ids.channels == 2 && shown.channels >= 3);
    int colours = 0;
    for (int i = 1; i < 48 * 32; i++) {
        const float *id = &ids.pixels[2 * i], *color = &shown.pixels[shown.channels * i];
        const bool same_id = id[0] == id[-2] && id[1] == id[-1];
        const bool same_color = memcmp(color, color - shown.channels, 3 * sizeof *color) == 0;
        CHECK(id[0] == floorf(id[0]) && id[1] == floorf(id[1]));
        CHECK((id[0] >= 0.0f) == (depth.pixels[i] > 0.0f) && (id[0] >= 0.0f) == (id[1] >= 0.0f));
        CHECK((id[0] < 0.0f) == (color[0] == 0.0f && color[1] == 0.0f && color[2] == 0.0f));
        assert_true(same_id == same_color);
        colours += !same_color;
    }
    CHECK(colours > 20);
    image_finish(&ids, test_host());
    image_finish(&depth, test_host());
    image_finish(&shown, test_host());
}

TEST(statistics_have_the_keys_that_scripts_rely_on)
{
    require_device();
    char path[300], image[300];
    snprintf(path, sizeof path, "%s", test_path("stats.json"));
    snprintf(image, sizeof image, "%s", test_path("stats.png"));
    run_expect(0, SMALL, "--gi", "lpv:steps=4", "--frames", "4", "--frame-options",
               "keep_maps=false", "--stats", path, "-o", image, NULL);
    json_error_t error;
    json_t *stats = json_load_file(path, 0, &error), *pass, *bytes;
    assert_non_null(stats);
    const char *device, *driver, *gi;
    int width, height, frames, steps;
    double median, p95, bake_seconds;
    json_t *passes, *memory;
    assert_int_equal(
        json_unpack(
            stats,
            "{s:s, s:s, s:[ii], s:i, s:s, s:{s:{s:i}}, s:o, s:{s:F, s:F}, s:o, s:{s:F, s:i}}",
            "device", &device, "driver", &driver, "size", &width, &height, "frames", &frames, "gi",
            &gi, "options", "lpv", "steps", &steps, "passes", &passes, "frame_ms", "median",
            &median, "p95", &p95, "memory_bytes", &memory, "bake", "seconds", &bake_seconds,
            "bytes", &height),
        0);
    CHECK(width == 48 && frames == 4 && steps == 4);
    CHECK(median > 0 && p95 >= median);
    size_t i;
    bool has_gbuffer = false, has_propagate = false;
    json_array_foreach(passes, i, pass)
    {
        const char *name;
        assert_int_equal(json_unpack(pass, "{s:s, s:{s:F, s:F}}", "name", &name, "gpu_ms", "median",
                                     &median, "p95", &p95),
                         0);
        has_gbuffer |= strcmp(name, "gbuffer") == 0;
        has_propagate |= strcmp(name, "lpv.propagate") == 0;
        CHECK(strcmp(name, "frame") != 0);
    }
    CHECK(has_gbuffer && has_propagate);
    const char *owner;
    double total = 0;
    json_object_foreach(memory, owner, bytes) total += json_number_value(bytes);
    CHECK(total > 48 * 32 * 8);
    json_decref(stats);
}

TEST(json_goes_only_to_standard_output)
{
    require_device();
    const char *path = test_path("json.png");
    const struct run *r = run_expect(0, SMALL, "--json", "-o", path, NULL);
    json_t *result = run_json(r);
    CHECK_STRING(json_string_value(json_object_get(result, "scene")), "@cornell:light=point");
    CHECK_STRING(json_string_value(json_object_get(result, "output")), path);
    CHECK(json_is_number(json_object_get(result, "exposure_ev")));
    CHECK_STRING(r->err, "");
    json_decref(result);
}

TEST(every_layer_can_be_a_png)
{
    require_device();
    static const char *const layers[] = { "color",      "direct",   "indirect", "irradiance",
                                          "visibility", "specular", "albedo",   "normal",
                                          "depth",      "position", "display",  "motion",
                                          "id" };
    for (size_t i = 0; i < sizeof layers / sizeof layers[0]; i++) {
        char path[300];
        struct image image = { 0 };
        snprintf(path, sizeof path, "%s", test_path("layer.png"));
        run_expect(0, SMALL, "--aov", layers[i], "-o", path, NULL);
        assert_true(png_read(test_host(), path, &image));
        assert_int_equal(image.width, 48);
        assert_int_equal(image.height, 32);
        image_finish(&image, test_host());
    }
}

TEST(a_render_causes_no_validation_message)
{
    require_device();
    const char *path = test_path("validated.exr");
    setenv("AFTERGLOW_VALIDATION", "1", 1);
    const struct run *r = run_expect(0, SMALL, "--gi", "lpv", "--frames", "3", "--aov",
                                     "color,indirect,normal,position", "-o", path, NULL);
    unsetenv("AFTERGLOW_VALIDATION");
    CHECK_STRING(r->err, "");
}

TEST(a_wrong_device_fails_and_leaves_nothing)
{
    char folder[256], path[300];
    snprintf(folder, sizeof folder, "%s", make_folder("device"));
    snprintf(path, sizeof path, "%s/out.png", folder);
    check_one_error_line(run_expect(1, SMALL, "--device", "no-such-gpu", "-o", path, NULL));
    const struct run *r = run_expect(1, "render @cornell --device 4711 -o", path, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "cannot find gpu device 4711: the devices are 0 \"") ||
          strstr(r->err, "there is no Vulkan device"));
    assert_int_equal(count_files(folder), 0);
}

TEST(the_default_file_name_is_that_of_the_scene)
{
    require_device();
    char before[1024];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(make_folder("here")), 0);
    const struct run *r = run_expect(0, "render @cornell:light=point --size 16x16", NULL);
    bool there = file_exists("cornell.png");
    assert_int_equal(chdir(before), 0);
    CHECK(there);
    CHECK(strstr(r->err, "cornell.png"));
}

static bool equal_layers(const char *a, const char *b, const char *layer)
{
    struct image x = read_layer(a, layer), y = read_layer(b, layer);
    const size_t values = (size_t)x.width * (size_t)x.height * (size_t)x.channels;
    const bool equal = memcmp(x.pixels, y.pixels, values * sizeof(float)) == 0;
    image_finish(&x, test_host());
    image_finish(&y, test_host());
    return equal;
}

static void copy_path(char out[300], const char *name)
{
    snprintf(out, 300, "%s", test_path(name));
}

TEST(antialias_averages_light_and_keeps_geometry)
{
    require_device();
    static const char layers[] = "color,direct,indirect,albedo,depth,normal,position,motion,id";
    char one[300], many[300];
    copy_path(one, "one.exr");
    copy_path(many, "many.exr");
    run_expect(0, SMALL, "--gi", "ambient", "--aov", layers, "-o", one, NULL);
    run_expect(0, SMALL, "--gi", "ambient", "--aov", layers, "--antialias", "16", "-o", many, NULL);
    static const char *const geometry[] = { "depth", "normal", "position", "motion", "id" };
    for (size_t i = 0; i < sizeof geometry / sizeof *geometry; i++)
        if (!equal_layers(one, many, geometry[i])) fail_msg("%s differs", geometry[i]);
    static const char *const light[] = { "direct", "indirect", "albedo" };
    for (size_t i = 0; i < sizeof light / sizeof *light; i++)
        if (equal_layers(one, many, light[i])) fail_msg("%s is of one frame", light[i]);
    // The color differs by the share of the bright emitter.
    CHECK_NEAR(mean_of(many, "albedo"), mean_of(one, "albedo"), 0.02);
    struct image color = read_layer(many, NULL), direct = read_layer(many, "direct"),
                 indirect = read_layer(many, "indirect");
    const double scale = mean(&color);
    for (int i = 0; i < color.width * color.height * 3; i++) {
        const double sum = (double)direct.pixels[i] + (double)indirect.pixels[i];
        CHECK_NEAR(sum, color.pixels[i], 2e-3 * fabs(sum) + 1e-4 * scale);
    }
    image_finish(&color, test_host());
    image_finish(&direct, test_host());
    image_finish(&indirect, test_host());
    char *value = exr_attribute_value(test_host(), many, "afterglow.antialias");
    assert_non_null(value);
    CHECK_STRING(value, "16");
    host_free(test_host(), value);
}

TEST(antialias_by_one_is_the_file_without)
{
    require_device();
    char without[300], one[300];
    copy_path(without, "without.exr");
    copy_path(one, "by-one.exr");
    run_expect(0, SMALL, "-o", without, NULL);
    run_expect(0, SMALL, "--antialias", "1", "-o", one, NULL);
    CHECK(files_are_equal(without, one));
}

// Metered once: all frames, and those without, have one exposure.
TEST(antialias_has_the_exposure_of_the_frame)
{
    require_device();
    char one[300], many[300];
    copy_path(one, "exposed.exr");
    copy_path(many, "exposed-many.exr");
    run_expect(0, SMALL, "-o", one, NULL);
    run_expect(0, SMALL, "--antialias", "4", "-o", many, NULL);
    char *a = exr_attribute_value(test_host(), one, "afterglow.exposure_ev");
    char *b = exr_attribute_value(test_host(), many, "afterglow.exposure_ev");
    assert_non_null(a);
    assert_non_null(b);
    CHECK_STRING(a, b);
    host_free(test_host(), a);
    host_free(test_host(), b);
}

// The layer display is the tone-mapped mean of radiance, as a PNG of color.
TEST(the_display_of_antialiased_frames_is_that_of_their_mean)
{
    require_device();
    char color[300], display[300];
    copy_path(color, "mean-color.png");
    copy_path(display, "mean-display.png");
    run_expect(0, SMALL, "--antialias", "4", "-o", color, NULL);
    run_expect(0, SMALL, "--antialias", "4", "--aov", "display", "-o", display, NULL);
    CHECK(files_are_equal(color, display));
}

TEST(a_wrong_number_of_samples_is_refused)
{
    static const char *const wrong[] = { "0", "-1", "4097", "x", "2.5" };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        run_expect(2, SMALL, "--antialias", wrong[i], NULL);
    run_expect(2, SMALL, "--antialias", "4", "--frame-options", "antialias=temporal", NULL);
}
