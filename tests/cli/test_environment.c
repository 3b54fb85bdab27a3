// --environment: its values, the light that it replaces, and where it is recorded.
#include "cli/program.h"

#include "image/exr.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A map of 8 × 4 texels; the image's left half has another radiance.
static const char *write_map(const char *name, float left, float right)
{
    struct image image;
    const char *path = path_of(name);
    assert_true(image_init(&image, test_host(), 8, 4, 3));
    for (int i = 0; i < 8 * 4 * 3; i++) image.pixels[i] = i / 3 % 8 < 4 ? left : right;
    assert_true(exr_write(test_host(), path, &(struct exr_layer){ "color", &image }, 1, NULL, 0));
    image_finish(&image, test_host());
    return path;
}

static struct image read_layer(const char *path, const char *layer)
{
    struct image image = { 0 };
    if (!exr_read(test_host(), path, layer, &image)) fail_msg("%s", test_last_message());
    return image;
}

// ---- values

TEST(wrong_values_name_what_is_accepted)
{
    static const struct {
        const char *value, *names;
    } cases[] = {
        { "foo", "FILE.hdr, FILE.exr or sun-sky" },
        { "photo.png", "FILE.hdr, FILE.exr or sun-sky" },
        { "photo.jpg:rotation=3", "FILE.hdr, FILE.exr or sun-sky" },
        { "sun-sky:", "with members after a colon" },
        { "sky.hdr:rotation", "with members after a colon" },
        { "sky.hdr:rotation=x", "name=number" },
        { "sky.hdr:rotation=nan", "name=number" },
        { "sun-sky:rotation=1,", "name=number" },
        { "sun-sky:rotation=1,,azimuth=2", "name=number" },
        { "sky.hdr:elevation=3", "rotation, strength and turn" },
        { "sun-sky:height=1", "elevation, azimuth, turbidity, rotation, strength and turn" },
        { "sun-sky:turbidity=1", "turbidity must be 2 to 10" },
        { "sun-sky:turbidity=10.5", "turbidity must be 2 to 10" },
        { "sun-sky:elevation=95", "-90 to 90 degrees" },
        { "sun-sky:elevation=-91", "-90 to 90 degrees" },
        { "sky.hdr:strength=-1", "strength must be 0 to 1e6" },
        { "sky.exr:strength=2e6", "strength must be 0 to 1e6" },
    };
    char folder[256], image[300];
    snprintf(folder, sizeof folder, "%s", make_folder("wrong-environments"));
    snprintf(image, sizeof image, "%s/out.exr", folder);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct run *r = run_expect(2, "reference @cornell --size 8x8 --environment",
                                         cases[i].value, "-o", image, NULL);
        check_one_error_line(r);
        if (!strstr(r->err, "--environment") || !strstr(r->err, cases[i].value) ||
            !strstr(r->err, cases[i].names))
            fail_msg("%s: does not name \"%s\": %s", cases[i].value, cases[i].names, r->err);
        assert_int_equal(count_files(folder), 0);
    }
}

TEST(files_that_cannot_be_read_are_named)
{
    char folder[256], image[300];
    snprintf(folder, sizeof folder, "%s", make_folder("no-environments"));
    snprintf(image, sizeof image, "%s/out.exr", folder);
    const char *damaged = path_of("damaged.hdr");
    write_file(damaged, "#?RADIANCE\n\n", 12);
    const char *const paths[] = { "absent.hdr", "absent.exr", "no/folder.exr", damaged };
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        const struct run *r = run_expect(1, "reference @cornell --size 8x8 --environment", paths[i],
                                         "-o", image, NULL);
        check_one_error_line(r);
        CHECK(strstr(r->err, paths[i]));
        assert_int_equal(count_files(folder), 0);
    }
}

// ---- light

#define SPHERES "reference @spheres --size 24x16 --spp 4 --quiet"
#define UPWARDS SPHERES " --eye 0,90,0 --target 1,100,1"
#define MANY    "reference @spheres --size 24x16 --spp 32 --quiet"

// The first pixel.
static void check_background(const char *path, double red, double green, double blue)
{
    struct image image = read_layer(path, "color");
    CHECK_RELATIVE(image.pixels[0], red, 1e-4);
    CHECK_RELATIVE(image.pixels[1], green, 1e-4);
    CHECK_RELATIVE(image.pixels[2], blue, 1e-4);
    image_finish(&image, test_host());
}

TEST(the_environment_replaces_the_scenes_sky_unless_there_is_another)
{
    const char *map = write_map("seven.exr", 7, 7), *out = path_of("spheres.exr");
    char twice[320];
    snprintf(twice, sizeof twice, "%s:strength=2,rotation=90", map);
    run_expect(0, UPWARDS, "-o", out, NULL);
    check_background(out, 2500, 3000, 4000); // of the scene
    run_expect(0, UPWARDS, "--environment", map, "-o", out, NULL);
    check_background(out, 7, 7, 7);
    run_expect(0, UPWARDS, "--environment", twice, "--sky", "1,2,3", "-o", out, NULL);
    check_background(out, 15, 16, 17);
}

static bool same_color(const char *a, const char *b)
{
    struct image images[2] = { read_layer(a, "color"), read_layer(b, "color") };
    const size_t bytes = sizeof(float) * 3 * (size_t)(images[0].width * images[0].height);
    const bool same = images[0].width == images[1].width &&
                      memcmp(images[0].pixels, images[1].pixels, bytes) == 0;
    image_finish(&images[0], test_host());
    image_finish(&images[1], test_host());
    return same;
}

TEST(a_whole_turn_is_none)
{
    const char *map = write_map("halves.exr", 1, 5);
    const char *const turns[] = { "0", "360", "-720", "180" };
    char value[320];
    const char *out[4];
    for (int i = 0; i < 4; i++) {
        snprintf(value, sizeof value, "%s:rotation=%s", map, turns[i]);
        char name[32];
        snprintf(name, sizeof name, "turn%s.exr", turns[i]);
        out[i] = path_of(name);
        run_expect(0, SPHERES, "--environment", value, "-o", out[i], NULL);
    }
    CHECK(same_color(out[0], out[1]) && same_color(out[0], out[2]));
    CHECK(!same_color(out[0], out[3]));
}

// A map whose light comes from the left half: the turned one lights as the mirrored one.
TEST(half_a_turn_exchanges_the_halves)
{
    const char *left = write_map("left.exr", 6, 2), *right = write_map("right.exr", 2, 6);
    const char *a = path_of("turned.exr"), *b = path_of("exchanged.exr");
    char value[320];
    snprintf(value, sizeof value, "%s:rotation=180", left);
    run_expect(0, MANY " --environment", value, "-o", a, NULL);
    run_expect(0, MANY " --environment", right, "-o", b, NULL);
    struct image x = read_layer(a, "color"), y = read_layer(b, "color");
    double sum = 0, difference = 0;
    for (int i = 0; i < 3 * x.width * x.height; i++) {
        sum += (double)y.pixels[i];
        difference += fabs((double)x.pixels[i] - (double)y.pixels[i]);
    }
    CHECK(difference < 0.05 * sum);
    image_finish(&x, test_host());
    image_finish(&y, test_host());
}

TEST(a_clear_sky_lights_a_frame)
{
    require_device();
    const char *out = path_of("clear.exr"), *night = path_of("night.exr");
    const char *words = "render @spheres --size 24x16 --gi ambient --quiet --no-scene-lights";
    const struct run *r =
        run_expect(0, words, "--environment", "sun-sky:elevation=40,turbidity=4", "-o", out, NULL);
    CHECK_STRING(r->err, "");
    run_expect(0, words, "--environment", "sun-sky:elevation=-30", "-o", night, NULL);
    struct image image = read_layer(out, "color"), dark = read_layer(night, "color");
    const size_t pixels = (size_t)(image.width * image.height);
    double day = 0, at_night = 0;
    for (size_t i = 0; i < pixels; i++) {
        day += (double)image.pixels[3 * i + 1];
        at_night += (double)dark.pixels[3 * i + 1];
    }
    CHECK(day / (double)pixels > 500 && at_night / (double)pixels < 1);
    image_finish(&image, test_host());
    image_finish(&dark, test_host());
}

// ---- records

TEST(reports_and_checkpoints_have_the_environment)
{
    require_device();
    const char *folder = make_folder("environment-report");
    char path[400];
    run_expect(0, "compare @cornell --size 24x18 --quiet --frames 2 --spp 2 --gi ambient",
               "--environment", "sun-sky:elevation=30", "--sky", "1,2,3", "-o", folder, NULL);
    snprintf(path, sizeof path, "%s/report.json", folder);
    json_t *report = json_load_file(path, 0, NULL);
    assert_non_null(report);
    const char *light = json_string_value(json_object_get(report, "light"));
    assert_non_null(light);
    CHECK(strstr(light, "--environment sun-sky:elevation=30"));
    CHECK(strstr(light, "--sky 1,2,3"));
    CHECK(strstr(json_string_value(json_object_get(report, "command")),
                 "--environment sun-sky:elevation=30"));
    json_decref(report);
}

// Another environment is another image: its samples are not added. The content of the file counts.
TEST(a_reference_is_not_resumed_under_another_environment)
{
    const char *map = write_map("first.exr", 1, 2), *other = write_map("second.exr", 2, 1);
    const char *out = path_of("resumed.exr");
    static const char resume[] =
        "reference @spheres --size 24x16 --spp 16 --quiet --resume --environment";
    run_expect(0, SPHERES, "--environment", map, "-o", out, NULL);
    const struct run *r = run_program(resume, other, "-o", out, NULL);
    CHECK(r->status != 0 && strstr(r->err, "light"));
    check_one_error_line(r);
    write_map("first.exr", 1, 3);
    r = run_program(resume, map, "-o", out, NULL);
    CHECK(r->status != 0);
    check_one_error_line(r);
    write_map("first.exr", 1, 2);
    run_expect(0, resume, map, "-o", out, NULL);
}
