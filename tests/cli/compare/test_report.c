// compare: documented output, errors known in advance, equal results, exposures.
#include "cli/compare/compare_run.h"

#include "image/exr.h"
#include "image/png_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_keys(json_t *object, const char *keys)
{
    char found[512] = "";
    const char *key;
    json_t *value;
    size_t used = 0;
    json_object_foreach(object, key, value)
    {
        int wrote = snprintf(found + used, sizeof found - used, "%s%s", used ? " " : "", key);
        used += (size_t)wrote;
    }
    CHECK_STRING(found, keys);
}

static void check_images(const char *folder, json_t *images, int width, int height)
{
    const char *key;
    json_t *name;
    json_object_foreach(images, key, name)
    {
        struct image image = { 0 };
        if (!png_read(test_host(), path_in(folder, json_string_value(name)), &image))
            fail_msg("%s: %s", key, test_last_message());
        assert_int_equal(image.width, width);
        assert_int_equal(image.height, height);
        image_finish(&image, test_host());
    }
}

// Without emission, the frame's direct light is that of the path tracer up to shadow edges; a
// shadow map of few texels is not.
TEST(the_error_of_direct_light_is_that_of_its_shadows)
{
    require_device();
    own_cache("direct-cache");
    double relmse[2];
    for (int i = 0; i < 2; i++) {
        const char *folder = path_of(i ? "direct-coarse" : "direct-fine");
        run_expect(0, "compare @cornell:light=point --size 48x36 --quiet --frames 2 --spp 4",
                   "--gi", "none", "--frame-options", i ? "shadow_size=128" : "shadow_size=2048",
                   "-o", folder, NULL);
        json_t *report = report_of(folder);
        relmse[i] = number_of(json_object_get(report, "direct"), "relmse");
        CHECK(relmse[i] < number_of(method_of(report, 0), "relmse"));
        json_decref(report);
    }
    CHECK(relmse[0] < 0.01 && relmse[1] > 4 * relmse[0]);
}

TEST(the_report_has_the_documented_fields_and_files)
{
    require_device();
    own_cache("contract-cache");
    const char *folder = path_of("contract");
    const struct run *r = run_expect(
        0, SCENE " --frames 3 --spp 2 --gi ambient --gi ambient:strength=0.5 -o", folder, NULL);
    CHECK(strstr(r->out, "\nambient:strength=0.5  ") && strstr(r->out, "2 samples"));
    CHECK(file_exists(path_in(folder, "report.html")));
    CHECK(file_exists(path_in(folder, "sheet.png")));
    json_t *report = report_of(folder);
    check_keys(
        report,
        "scene camera size exposure_ev reference methods device driver frames "
        "scene_scale indirect_exposure_ev direct command version date light light_is_default "
        "camera_is_default");
    check_keys(json_object_get(report, "direct"), "relmse flip mae images");
    check_images(folder, json_object_get(json_object_get(report, "direct"), "images"), 24, 18);
    const char *command = json_string_value(json_object_get(report, "command"));
    CHECK(strstr(command, "afterglow compare @cornell --size 24x18 --quiet") == command);
    CHECK(strstr(command, "--gi ambient:strength=0.5 -o "));
    json_t *reference = json_object_get(report, "reference");
    check_keys(reference, "spp bounces seconds noise noise_relmse rays cached images");
    check_images(folder, json_object_get(reference, "images"), 24, 18);
    assert_int_equal(json_array_size(json_object_get(report, "methods")), 2);
    for (size_t i = 0; i < 2; i++) {
        json_t *method = method_of(report, i);
        check_keys(method,
                   "gi options relmse flip mae ssim energy indirect frame_ms passes memory_bytes "
                   "flip_hdr images irradiance changed");
        check_keys(json_object_get(method, "indirect"), "relmse mae energy");
        check_keys(json_object_get(method, "irradiance"), "relmse mae energy");
        check_keys(json_object_get(method, "frame_ms"), "median p95");
        check_keys(json_object_get(method, "images"), "picture error indirect indirect_error");
        check_images(folder, json_object_get(method, "images"), 24, 18);
        CHECK(json_array_size(json_object_get(method, "passes")) > 2);
        CHECK(number_of(json_object_get(method, "memory_bytes"), "scene") > 0);
    }
    CHECK_STRING(json_string_value(json_object_get(report, "scene")), "@cornell");
    CHECK_STRING(json_string_value(json_object_get(method_of(report, 0), "gi")), "ambient");
    CHECK_STRING(json_string_value(json_object_get(method_of(report, 1), "gi")),
                 "ambient:strength=0.5");
    json_t *options = json_object_get(json_object_get(method_of(report, 1), "options"), "ambient");
    CHECK_NEAR(number_of(options, "strength"), 0.5, 0);
    CHECK(strstr(r->out, "direct light alone"));
    json_t *changed = json_object_get(method_of(report, 0), "changed");
    assert_int_equal(json_object_size(json_object_get(changed, "ambient")), 0);
    changed = json_object_get(json_object_get(method_of(report, 1), "changed"), "ambient");
    assert_int_equal(json_object_size(changed), 1);
    CHECK_NEAR(number_of(changed, "strength"), 0.5, 0);
    // Half the strength, half the light: the energy of indirect light shows it.
    double whole = number_of(json_object_get(method_of(report, 0), "indirect"), "energy"),
           half = number_of(json_object_get(method_of(report, 1), "indirect"), "energy");
    CHECK_RELATIVE(half, 0.5 * whole, 0.002); // half floats
    assert_int_equal((int)number_of(report, "frames"), 3);
    CHECK(json_is_null(json_object_get(reference, "bounces")));
    CHECK(json_is_false(json_object_get(reference, "cached")));
    assert_int_equal((int)number_of(reference, "spp"), 2);
    json_decref(report);
    char *names = exr_layer_names(test_host(), path_in(folder, "2-ambient-strength-0.5.exr"));
    CHECK_STRING(names, "color\nindirect\nirradiance");
    host_free(test_host(), names);
    // --json prints the content of the file.
    r = run_expect(0, SMALL " --json -o", folder, NULL);
    json_t *printed = run_json(r);
    report = report_of(folder);
    CHECK(json_equal(printed, report));
    json_decref(report);
    json_decref(printed);
}

// Noise of some samples is most of a good image's error, and little of a black one's. It is little
// of the good one's, too, with as many samples as are named: few underestimate the noise.
TEST(noise_that_hides_errors_is_named)
{
    require_device();
    own_cache("share-cache");
    const char *good = SCENE " --frames 2 --gi radiosity:texels=4096,rays=64 -o";
    const char *folder = path_of("share"), *named = "of the least relmse", *option = ": --spp ";
    char spp[16] = "16";
    int runs = 0;
    for (const char *next = option; next && runs < 4; runs++) {
        const struct run *r = run_expect(0, good, folder, "--spp", spp, NULL);
        next = strstr(r->out, option);
        CHECK(!next == !strstr(r->out, named));
        if (next) CHECK(sscanf(next + strlen(option), "%15[0-9]", spp) == 1);
    }
    CHECK(runs == 2 || runs == 3);
    const struct run *r = run_expect(0, SCENE " --frames 2 --spp 64 --gi none -o", folder, NULL);
    CHECK(!strstr(r->out, named));
}

// ---- errors known in advance

// Writes a frame's layers, times `scale`, as a reference file; `first` replaces its first value
// unless 0.
static const char *frame_as_reference(const char *name, float scale, float first)
{
    const char *frame = path_of("frame.exr"), *path = path_of(name);
    run_expect(0, "render @cornell --size 24x18 --quiet --gi ambient --aov color,indirect -o",
               frame, NULL);
    struct image color = read_layer(frame, NULL), indirect = read_layer(frame, "indirect");
    for (int i = 0; i < 24 * 18 * 3; i++) color.pixels[i] *= scale, indirect.pixels[i] *= scale;
    if (first != 0.0f) color.pixels[0] = first;
    const struct exr_layer layers[] = { { "color", &color },
                                        { "indirect_emitters_sky", &indirect } };
    assert_true(exr_write(test_host(), path, layers, 2, NULL, 0));
    image_finish(&color, test_host());
    image_finish(&indirect, test_host());
    return path;
}

TEST(a_method_equal_to_the_reference_has_no_error)
{
    require_device();
    const char *given = frame_as_reference("equal.exr", 1, 0), *folder = path_of("known");
    run_expect(0, SCENE " --frames 1 --gi ambient --gi none -o", folder, "--reference", given,
               NULL);
    json_t *report = report_of(folder), *method = method_of(report, 0);
    CHECK(number_of(method, "relmse") == 0 && number_of(method, "mae") == 0 &&
          number_of(method, "flip") == 0);
    CHECK_NEAR(number_of(method, "ssim"), 1, 1e-6);
    CHECK(number_of(method, "energy") == 1);
    json_t *indirect = json_object_get(method, "indirect");
    CHECK(number_of(indirect, "relmse") == 0 && number_of(indirect, "mae") == 0);
    CHECK(number_of(indirect, "energy") == 1);
    // The method none lacks all indirect light.
    indirect = json_object_get(method_of(report, 1), "indirect");
    CHECK(number_of(indirect, "energy") == 0);
    CHECK(number_of(method_of(report, 1), "energy") < 0.9 &&
          number_of(method_of(report, 1), "flip") > 0.1);
    json_t *reference = json_object_get(report, "reference");
    CHECK(!json_object_get(reference, "bounces"));
    CHECK(json_is_null(json_object_get(reference, "spp")) &&
          json_is_null(json_object_get(reference, "noise")));
    json_decref(report);
    CHECK(files_are_equal(given, path_in(folder, "reference.exr")));
    given = frame_as_reference("twice.exr", 2, 0);
    run_expect(0, SCENE " --frames 1 --gi ambient -o", folder, "--reference", given, NULL);
    report = report_of(folder);
    CHECK_RELATIVE(number_of(method_of(report, 0), "energy"), 0.5, 1e-6);
    CHECK_RELATIVE(number_of(json_object_get(method_of(report, 0), "indirect"), "energy"), 0.5,
                   1e-6);
    json_decref(report);
}

TEST(nan_pixels_are_an_error_or_ignored)
{
    require_device();
    const char *given = frame_as_reference("nan.exr", 1, NAN), *folder = path_of("nan");
    const struct run *r =
        run_expect(1, SCENE " --frames 1 --gi ambient -o", folder, "--reference", given, NULL);
    CHECK(strstr(r->err, "1 of its pixels"));
    CHECK(!file_exists(folder));
    run_expect(0, SCENE " --frames 1 --gi ambient --ignore-nan -o", folder, "--reference", given,
               NULL);
    json_t *report = report_of(folder);
    CHECK(number_of(method_of(report, 0), "mae") == 0);
    assert_int_equal((int)number_of(method_of(report, 0), "pixels"), 24 * 18 - 1);
    json_decref(report);
}

// ---- reproducibility

TEST(equal_methods_and_equal_commands_have_equal_results)
{
    require_device();
    own_cache("twice-cache");
    const char *a = path_of("twice-a"), *b = path_of("twice-b");
    run_expect(0, SCENE " --frames 2 --spp 2 --gi lpv --gi lpv -o", a, NULL);
    run_expect(0, SCENE " --frames 2 --spp 2 --gi lpv --gi lpv --no-cache -o", b, NULL);
    json_t *first = report_of(a), *second = report_of(b);
    check_equal_numbers(method_of(first, 0), method_of(first, 1));
    check_equal_numbers(method_of(first, 0), method_of(second, 0));
    json_decref(first);
    json_decref(second);
    static const char *const files[] = { "1-lpv.png", "1-lpv.exr", "1-lpv-flip.png",
                                         "1-lpv-indirect.png", "1-lpv-indirect-error.png" };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char other[64];
        snprintf(other, sizeof other, "2%s", files[i] + 1);
        CHECK(files_are_equal(path_in(a, files[i]), path_in(a, other)));
        CHECK(files_are_equal(path_in(a, files[i]), path_in(b, files[i])));
    }
    CHECK(files_are_equal(path_in(a, "reference.png"), path_in(b, "reference.png")));
    CHECK(files_are_equal(path_in(a, "reference.exr"), path_in(b, "reference.exr")));
}

TEST(the_exposure_is_that_of_the_reference_or_the_given_one)
{
    require_device();
    own_cache("exposure-cache");
    const char *folder = path_of("exposure"), *png = path_of("exposure.png");
    run_expect(0, SMALL " -o", folder, NULL);
    json_t *report = report_of(folder);
    json_t *traced = run_json(
        run_expect(0, "reference @cornell --size 24x18 --spp 2 --quiet --json -o", png, NULL));
    CHECK(number_of(report, "exposure_ev") == number_of(traced, "exposure_ev"));
    CHECK(files_are_equal(png, path_in(folder, "reference.png")));
    json_decref(report);
    json_decref(traced);
    run_expect(0, SMALL " --exposure 3.25 -o", folder, NULL);
    run_expect(0, "render @cornell --size 24x18 --quiet --exposure 3.25 -o", png, NULL);
    report = report_of(folder);
    CHECK_NEAR(number_of(report, "exposure_ev"), 3.25, 0);
    json_decref(report);
    CHECK(files_are_equal(png, path_in(folder, "1-none.png")));
}

// A floor and a wall of an albedo that leaves little indirect light.
static const char *write_dark_corner(const char *name)
{
    char text[1024];
    int used = snprintf(text, sizeof text,
                        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\n"
                        "property float y\nproperty float z\nproperty uchar red\n"
                        "property uchar green\nproperty uchar blue\nelement face 2\n"
                        "property list uchar int vertex_indices\nend_header\n");
    static const char *const corners[] = { "0 0 0", "4 0 0", "4 0 4", "0 0 4", "4 4 0", "0 4 0" };
    for (int i = 0; i < 6; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%s 10 10 10\n", corners[i]);
    snprintf(text + used, sizeof text - (size_t)used, "4 0 3 2 1\n4 0 1 4 5\n");
    const char *path = path_of(name);
    write_file(path, text, strlen(text));
    return path;
}

static double brightest(const char *path)
{
    struct image image = { 0 };
    float most = 0.0f;
    assert_true(png_read(test_host(), path, &image));
    for (int i = 0; i < image.width * image.height * image.channels; i++)
        most = fmaxf(most, image.pixels[i]);
    image_finish(&image, test_host());
    return (double)most;
}

static const char CORNER[] =
    "compare --size 24x18 --spp 4 --frames 1 --quiet --gi lpv:dim=16 --eye "
    "2,2,7 --target 2,1,0 --light point:2,2,2:50,50,50 -o";

TEST(dim_indirect_light_has_an_exposure_of_its_own)
{
    require_device();
    own_cache("indirect-exposure-cache");
    const char *folder = path_of("indirect-exposure"), *dark = write_dark_corner("dark.ply");
    run_expect(0, CORNER, folder, dark, NULL);
    json_t *report = report_of(folder);
    const double ev = number_of(report, "exposure_ev");
    CHECK(number_of(report, "indirect_exposure_ev") < ev - 2);
    CHECK(brightest(path_in(folder, "reference-indirect.png")) > 0.3);
    json_decref(report);
    run_expect(0,
               "compare @cornell:light=point --size 24x18 --spp 2 --frames 1 --gi none --quiet -o",
               folder, NULL); // its indirect light is not dim
    report = report_of(folder);
    CHECK(number_of(report, "indirect_exposure_ev") == number_of(report, "exposure_ev"));
    json_decref(report);
    run_expect(0, CORNER, folder, dark, "--exposure", "1.5", NULL); // as it was asked for
    report = report_of(folder);
    CHECK_NEAR(number_of(report, "indirect_exposure_ev"), 1.5, 0);
    CHECK(brightest(path_in(folder, "reference-indirect.png")) < 0.3);
    json_decref(report);
}

TEST(black_indirect_light_keeps_the_exposure_of_the_image)
{
    require_device();
    own_cache("black-indirect-cache");
    const char *folder = path_of("black-indirect");
    run_expect(0,
               "compare @cornell:light=point --bounces 0 --size 24x18 --spp 2 --frames 1 "
               "--gi none --quiet -o",
               folder, NULL);
    json_t *report = report_of(folder);
    CHECK(number_of(report, "indirect_exposure_ev") == number_of(report, "exposure_ev"));
    json_decref(report);
}
