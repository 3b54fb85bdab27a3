// compare: documented output, errors known in advance, cached samples, complete folders.
#include "cli/program.h"

#include "image/exr.h"
#include "image/png_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define SCENE "compare @cornell --size 24x18 --quiet"
#define SMALL SCENE " --frames 2 --spp 2 --gi none"

// Both results are valid until some calls later.
static const char *path_of(const char *name)
{
    static char paths[8][400];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s", test_path(name));
    return path;
}

static const char *in(const char *folder, const char *name)
{
    static char paths[8][600];
    static int next;
    char path[600];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        fail_msg("too long: %s", path);
    return memcpy(paths[next++ % 8], path, sizeof path);
}

// Creates a cache for the test and returns its folder.
static const char *own_cache(const char *name)
{
    static char folder[600];
    setenv("AFTERGLOW_CACHE", path_of(name), 1);
    snprintf(folder, sizeof folder, "%s/references", getenv("AFTERGLOW_CACHE"));
    return folder;
}

static json_t *report_of(const char *folder)
{
    json_error_t error;
    json_t *report = json_load_file(in(folder, "report.json"), 0, &error);
    if (!report) fail_msg("%s/report.json, line %d: %s", folder, error.line, error.text);
    return report;
}

static json_t *method_of(const json_t *report, size_t index)
{
    return json_array_get(json_object_get(report, "methods"), index);
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value)) fail_msg("no number %s", key);
    return json_number_value(value);
}

static double of_reference(const json_t *report, const char *key)
{
    return number(json_object_get(report, "reference"), key);
}

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
        if (!png_read(test_host(), in(folder, json_string_value(name)), &image))
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
        relmse[i] = number(json_object_get(report, "direct"), "relmse");
        CHECK(relmse[i] < number(method_of(report, 0), "relmse"));
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
    CHECK(file_exists(in(folder, "report.html")));
    CHECK(file_exists(in(folder, "sheet.png")));
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
        CHECK(number(json_object_get(method, "memory_bytes"), "scene") > 0);
    }
    CHECK_STRING(json_string_value(json_object_get(report, "scene")), "@cornell");
    CHECK_STRING(json_string_value(json_object_get(method_of(report, 0), "gi")), "ambient");
    CHECK_STRING(json_string_value(json_object_get(method_of(report, 1), "gi")),
                 "ambient:strength=0.5");
    json_t *options = json_object_get(json_object_get(method_of(report, 1), "options"), "ambient");
    CHECK_NEAR(number(options, "strength"), 0.5, 0);
    CHECK(strstr(r->out, "direct light alone"));
    json_t *changed = json_object_get(method_of(report, 0), "changed");
    assert_int_equal(json_object_size(json_object_get(changed, "ambient")), 0);
    changed = json_object_get(json_object_get(method_of(report, 1), "changed"), "ambient");
    assert_int_equal(json_object_size(changed), 1);
    CHECK_NEAR(number(changed, "strength"), 0.5, 0);
    // Half the strength, half the light: the energy of indirect light shows it.
    double whole = number(json_object_get(method_of(report, 0), "indirect"), "energy"),
           half = number(json_object_get(method_of(report, 1), "indirect"), "energy");
    CHECK_RELATIVE(half, 0.5 * whole, 0.002); // half floats
    assert_int_equal((int)number(report, "frames"), 3);
    CHECK(json_is_null(json_object_get(reference, "bounces")));
    CHECK(json_is_false(json_object_get(reference, "cached")));
    assert_int_equal((int)number(reference, "spp"), 2);
    json_decref(report);
    char *names = exr_layer_names(test_host(), in(folder, "2-ambient-strength-0.5.exr"));
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

static struct image read_layer(const char *path, const char *layer)
{
    struct image image = { 0 };
    if (!exr_read(test_host(), path, layer, &image)) fail_msg("%s", test_last_message());
    return image;
}

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
    CHECK(number(method, "relmse") == 0 && number(method, "mae") == 0 &&
          number(method, "flip") == 0);
    CHECK_NEAR(number(method, "ssim"), 1, 1e-6);
    CHECK(number(method, "energy") == 1);
    json_t *indirect = json_object_get(method, "indirect");
    CHECK(number(indirect, "relmse") == 0 && number(indirect, "mae") == 0);
    CHECK(number(indirect, "energy") == 1);
    // The method none lacks all indirect light.
    indirect = json_object_get(method_of(report, 1), "indirect");
    CHECK(number(indirect, "energy") == 0);
    CHECK(number(method_of(report, 1), "energy") < 0.9 &&
          number(method_of(report, 1), "flip") > 0.1);
    json_t *reference = json_object_get(report, "reference");
    CHECK(!json_object_get(reference, "bounces"));
    CHECK(json_is_null(json_object_get(reference, "spp")) &&
          json_is_null(json_object_get(reference, "noise")));
    json_decref(report);
    CHECK(files_are_equal(given, in(folder, "reference.exr")));
    given = frame_as_reference("twice.exr", 2, 0);
    run_expect(0, SCENE " --frames 1 --gi ambient -o", folder, "--reference", given, NULL);
    report = report_of(folder);
    CHECK_RELATIVE(number(method_of(report, 0), "energy"), 0.5, 1e-6);
    CHECK_RELATIVE(number(json_object_get(method_of(report, 0), "indirect"), "energy"), 0.5, 1e-6);
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
    CHECK(number(method_of(report, 0), "mae") == 0);
    assert_int_equal((int)number(method_of(report, 0), "pixels"), 24 * 18 - 1);
    json_decref(report);
}

// ---- reproducibility

static void check_equal_numbers(const json_t *a, const json_t *b)
{
    static const char *const keys[] = { "relmse", "flip", "mae", "ssim", "energy", "flip_hdr" };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        CHECK(number(a, keys[i]) == number(b, keys[i]));
    CHECK(json_equal(json_object_get(a, "indirect"), json_object_get(b, "indirect")));
    CHECK(json_equal(json_object_get(a, "options"), json_object_get(b, "options")));
}

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
        CHECK(files_are_equal(in(a, files[i]), in(a, other)));
        CHECK(files_are_equal(in(a, files[i]), in(b, files[i])));
    }
    CHECK(files_are_equal(in(a, "reference.png"), in(b, "reference.png")));
    CHECK(files_are_equal(in(a, "reference.exr"), in(b, "reference.exr")));
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
    CHECK(number(report, "exposure_ev") == number(traced, "exposure_ev"));
    CHECK(files_are_equal(png, in(folder, "reference.png")));
    json_decref(report);
    json_decref(traced);
    run_expect(0, SMALL " --exposure 3.25 -o", folder, NULL);
    run_expect(0, "render @cornell --size 24x18 --quiet --exposure 3.25 -o", png, NULL);
    report = report_of(folder);
    CHECK_NEAR(number(report, "exposure_ev"), 3.25, 0);
    json_decref(report);
    CHECK(files_are_equal(png, in(folder, "1-none.png")));
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
    const double ev = number(report, "exposure_ev");
    CHECK(number(report, "indirect_exposure_ev") < ev - 2);
    CHECK(brightest(in(folder, "reference-indirect.png")) > 0.3);
    json_decref(report);
    run_expect(0,
               "compare @cornell:light=point --size 24x18 --spp 2 --frames 1 --gi none --quiet -o",
               folder, NULL); // its indirect light is not dim
    report = report_of(folder);
    CHECK(number(report, "indirect_exposure_ev") == number(report, "exposure_ev"));
    json_decref(report);
    run_expect(0, CORNER, folder, dark, "--exposure", "1.5", NULL); // as it was asked for
    report = report_of(folder);
    CHECK_NEAR(number(report, "indirect_exposure_ev"), 1.5, 0);
    CHECK(brightest(in(folder, "reference-indirect.png")) < 0.3);
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
    CHECK(number(report, "indirect_exposure_ev") == number(report, "exposure_ev"));
    json_decref(report);
}

// ---- cached references

TEST(a_reference_is_traced_once_and_continued)
{
    require_device();
    const char *cache = own_cache("kept-cache"), *folder = path_of("kept");
    run_expect(0, SMALL " -o", folder, NULL);
    assert_int_equal(count_files(cache), 1);
    json_t *first = report_of(folder);
    run_expect(0, SMALL " -o", folder, NULL);
    json_t *second = report_of(folder);
    CHECK(json_is_false(json_object_get(json_object_get(first, "reference"), "cached")));
    CHECK(json_is_true(json_object_get(json_object_get(second, "reference"), "cached")));
    check_equal_numbers(method_of(first, 0), method_of(second, 0));
    CHECK(of_reference(first, "seconds") == of_reference(second, "seconds"));
    CHECK(of_reference(first, "rays") == of_reference(second, "rays"));
    CHECK_RELATIVE(of_reference(first, "noise"), of_reference(second, "noise"),
                   1e-5); // 32-bit floats
    // More samples continue the cached ones; fewer need no tracing.
    run_expect(0, SMALL " --spp 5 -o", folder, NULL);
    json_t *third = report_of(folder);
    CHECK(json_is_false(json_object_get(json_object_get(third, "reference"), "cached")));
    assert_int_equal((int)of_reference(third, "spp"), 5);
    CHECK(of_reference(third, "rays") > of_reference(second, "rays"));
    CHECK(of_reference(third, "seconds") > of_reference(second, "seconds"));
    const char *whole = path_of("whole.exr");
    run_expect(0, "reference @cornell --size 24x18 --quiet --spp 5 -o", whole, NULL);
    struct image a = read_layer(whole, NULL), b = read_layer(in(folder, "reference.exr"), NULL);
    for (int i = 0; i < 24 * 18 * 3; i++) CHECK_RELATIVE(a.pixels[i], b.pixels[i], 1e-5);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    run_expect(0, SMALL " --spp 3 -o", folder, NULL);
    json_t *fourth = report_of(folder);
    CHECK(json_is_true(json_object_get(json_object_get(fourth, "reference"), "cached")));
    assert_int_equal((int)of_reference(fourth, "spp"), 5);
    assert_int_equal(count_files(cache), 1);
    // Another image has its own file; --no-cache writes none.
    run_expect(0, SMALL " --bounces 1 -o", folder, NULL);
    assert_int_equal(count_files(cache), 2);
    run_expect(0, SMALL " --bounces 2 --no-cache -o", folder, NULL);
    assert_int_equal(count_files(cache), 2);
    json_decref(first);
    json_decref(second);
    json_decref(third);
    json_decref(fourth);
}

TEST(a_damaged_or_unwritable_cache_is_no_error)
{
    require_device();
    const char *cache = own_cache("damaged-cache"), *folder = path_of("damaged");
    run_expect(0, SMALL " -o", folder, NULL);
    DIR *dir = opendir(cache);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));)
        if (entry->d_name[0] == 'r') write_file(in(cache, entry->d_name), "no image", 10);
    closedir(dir);
    const struct run *r = run_expect(
        0, "compare @cornell --size 24x18 --frames 1 --spp 2 --gi none -o", folder, NULL);
    CHECK(strstr(r->err, "traced again"));
    json_t *report = report_of(folder);
    CHECK(json_is_false(json_object_get(json_object_get(report, "reference"), "cached")));
    json_decref(report);
    write_file(path_of("no-folder"), "", 0);
    setenv("AFTERGLOW_CACHE", path_of("no-folder"), 1);
    run_expect(0, SMALL " -o", folder, NULL);
}

// A sparse file of 3 GB, unused for years.
static void make_old(const char *path)
{
    int fd = open(path, O_WRONLY | O_CREAT, 0600);
    const struct timespec times[2] = { { .tv_sec = 1e9 }, { .tv_sec = 1e9 } };
    assert_true(fd >= 0 && ftruncate(fd, 3000000000) == 0 && futimens(fd, times) == 0 &&
                close(fd) == 0);
}

TEST(the_cache_respects_its_size_limit_and_foreign_files)
{
    require_device();
    const char *cache = own_cache("bound-cache"), *folder = path_of("bound");
    run_expect(0, SMALL " -o", folder, NULL);
    make_old(in(cache, "reference-1-0123456789abcdef.exr"));
    make_old(in(cache, "holiday.exr"));
    run_expect(0, SMALL " --spp 3 -o", folder, NULL);
    CHECK(!file_exists(in(cache, "reference-1-0123456789abcdef.exr")));
    CHECK(file_exists(in(cache, "holiday.exr")));
    assert_int_equal(count_files(cache), 2);
}

TEST(a_reference_of_another_image_is_refused)
{
    require_device();
    own_cache("other-cache");
    const char *own = path_of("own"), *again = path_of("again");
    run_expect(0, SMALL " -o", own, NULL);
    const char *exr = in(own, "reference.exr");
    run_expect(0, SCENE " --frames 1 --gi none -o", again, "--reference", exr, NULL);
    json_t *first = report_of(own), *second = report_of(again);
    check_equal_numbers(method_of(first, 0), method_of(second, 0));
    assert_int_equal((int)of_reference(second, "spp"), 2);
    CHECK_RELATIVE(of_reference(first, "noise"), of_reference(second, "noise"), 1e-5);
    json_decref(first);
    json_decref(second);
    static const char *const others[] = {
        "compare @cornell --size 32x18 --gi none", // another size …
        "compare @cornell --size 24x18 --gi none --eye 0,3,12 --target 0,2,0",
        "compare @cornell --size 24x18 --gi none --bounces 1",
        "compare @cornell:light=point --size 24x18 --gi none",
        "compare @cornell --size 24x18 --gi none --sky 1,1,1",
    };
    const char *folder = path_of("refused");
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        check_one_error_line(run_expect(1, others[i], "-o", folder, "--reference", exr, NULL));
    check_one_error_line(
        run_expect(1, SCENE " -o", folder, "--reference", path_of("none.exr"), NULL));
    CHECK(!file_exists(folder));
    // Without the layer of indirect light only the image is compared.
    const char *bare = path_of("bare.exr");
    run_expect(0, "reference @cornell --size 24x18 --quiet --spp 2 --aov color -o", bare, NULL);
    run_expect(0, SCENE " --frames 1 --gi none -o", folder, "--reference", bare, NULL);
    json_t *report = report_of(folder);
    CHECK(json_is_null(json_object_get(method_of(report, 0), "indirect")));
    CHECK(number(method_of(report, 0), "flip") > 0);
    CHECK(!file_exists(in(folder, "reference-indirect.png")));
    json_decref(report);
}

// ---- bounds, usage, folders

static int count_lines(const char *text)
{
    int count = 0;
    while ((text = strchr(text, '\n'))) count++, text++;
    return count;
}

TEST(a_method_exceeding_a_bound_fails_after_the_report)
{
    require_device();
    own_cache("bounds-cache");
    const char *folder = path_of("bounds");
    const struct run *r =
        run_expect(1, SMALL " --gi ambient --max-flip 0.01 --max-relmse 1e9 -o", folder, NULL);
    assert_int_equal(count_lines(r->err), 2);
    CHECK(strstr(r->err, "afterglow: flip of none: 0.") && strstr(r->err, "--max-flip 0.01"));
    CHECK(file_exists(in(folder, "report.json")) && strstr(r->out, "\nambient"));
    r = run_expect(1, SMALL " --max-relmse 0 --max-ms 0 -o", folder, NULL);
    CHECK(strstr(r->err, "relmse of none") && strstr(r->err, "ms of none"));
    run_expect(0, SMALL " --max-flip 1 --max-relmse 1e9 --max-ms 1e9 -o", folder, NULL);
}

TEST(wrong_usage_is_reported_before_the_work)
{
    static const char *const wrong[] = {
        "--gi lvp",
        "--gi none --gi lpv:steps=0",
        "--frame-options size=3",
        "--max-flip -1",
        "--max-ms x",
        "--reference a.png",
        "--reference a.exr --spp 4",
        "--frames 0",
        "--aov color",
        "--gi lpv --eye 1,2,3",
        "--antialias",
    };
    char words[200];
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        snprintf(words, sizeof words, "compare @cornell %s -o", wrong[i]);
        check_one_error_line(run_expect(2, words, path_of("wrong"), NULL));
    }
    char many[400] = "compare @cornell";
    for (int i = 0; i < 17; i++) strcat(many, " --gi none");
    check_one_error_line(run_expect(2, many, NULL));
    check_one_error_line(run_expect(1, SMALL " --camera nobody -o", path_of("wrong"), NULL));
    CHECK(!file_exists(path_of("wrong")));
}

TEST(a_foreign_folder_is_left_alone)
{
    require_device();
    own_cache("folders-cache");
    char folder[400], file[500];
    snprintf(folder, sizeof folder, "%s", make_folder("folder"));
    snprintf(file, sizeof file, "%s/notes.txt", folder);
    write_file(file, "mine", 4);
    check_one_error_line(run_expect(1, SMALL " -o", folder, NULL)); // no report in it
    check_one_error_line(run_expect(1, SMALL " -o", file, NULL));
    check_one_error_line(run_expect(1, SMALL " -o", in(folder, "none/deeper"), NULL));
    check_one_error_line(run_expect(1, SMALL " -o", "/proc/compare", NULL));
    unlink(file);
    run_expect(0, SMALL " --gi ambient -o", folder, NULL); // an empty one
    CHECK(file_exists(in(folder, "2-ambient.png")));
    run_expect(0, SMALL " -o", folder, NULL); // one of its own; what was in it is gone
    CHECK(!file_exists(in(folder, "2-ambient.png")) && file_exists(in(folder, "1-none.png")));
    write_file(file, "mine", 4);
    const struct run *r = run_expect(1, SMALL " -o", folder, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "notes.txt"));
    unlink(file);
    // Through a symbolic link, and with a trailing slash.
    const char *link = path_of("link");
    assert_int_equal(symlink(folder, link), 0);
    run_expect(0, SMALL " --gi ambient -o", in(link, ""), NULL);
    CHECK(file_exists(in(folder, "2-ambient.png")));
    struct stat info;
    CHECK(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
    // The current folder is never replaced.
    char before[1000];
    assert_true(getcwd(before, sizeof before) && chdir(folder) == 0);
    check_one_error_line(run_expect(1, SMALL " -o .", NULL));
    assert_int_equal(chdir(before), 0);
    // The default name is that of the scene.
    assert_int_equal(chdir(make_folder("elsewhere")), 0);
    run_expect(0, SMALL, NULL);
    CHECK(file_exists("cornell-compare/report.json"));
    assert_int_equal(count_files("."), 1);
    assert_int_equal(chdir(before), 0);
}

// ---- interruption

static pid_t start(const char *words, const char *folder)
{
    static char text[2000];
    char *list[80] = { (char *)AFTERGLOW_PROGRAM };
    int count = 1;
    snprintf(text, sizeof text, "%s", words);
    char *rest = text;
    for (char *word; (word = strsep(&rest, " ")) && count < 77;) list[count++] = word;
    list[count++] = (char *)"-o";
    list[count++] = (char *)folder;
    fflush(NULL);
    pid_t child = fork();
    if (child < 0) fail_msg("cannot fork");
    if (child == 0) {
        signal(SIGINT, SIG_DFL);
        if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(126);
        execv(AFTERGLOW_PROGRAM, list);
        _exit(127);
    }
    return child;
}

static bool has_entry(const char *folder, const char *part)
{
    DIR *dir = opendir(folder);
    bool found = false;
    for (struct dirent *entry; dir && (entry = readdir(dir));)
        found |= strstr(entry->d_name, part) != NULL;
    if (dir) closedir(dir);
    return found;
}

TEST(ctrl_c_keeps_the_samples_and_leaves_no_folder)
{
    require_device();
    char home[400], folder[500];
    snprintf(home, sizeof home, "%s", make_folder("stopped"));
    snprintf(folder, sizeof folder, "%s/results", home);
    const char *cache = own_cache("stopped-cache");
    pid_t child = start("compare @cornell --size 24x18 --frames 1 --gi none --spp 1000000", folder);
    for (int i = 0; i < 60000 * test_time_factor() && !has_entry(cache, "reference"); i++)
        test_pause_ms(1);
    test_pause_ms(200 * test_time_factor()); // the first samples are written; more are being traced
    assert_int_equal(kill(child, SIGINT), 0);
    int status = 0;
    assert_true(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    CHECK(!file_exists(folder) && !has_entry(home, ".tmp-"));
    assert_int_equal(count_files(cache), 1);
    // The next run uses them.
    run_expect(0, SMALL " -o", folder, NULL);
    json_t *report = report_of(folder);
    CHECK(json_is_true(json_object_get(json_object_get(report, "reference"), "cached")));
    CHECK(of_reference(report, "spp") > 2);
    json_decref(report);
}

TEST(a_signal_while_the_folder_is_filled_leaves_none)
{
    require_device();
    own_cache("filled-cache");
    char home[400], folder[500], words[600];
    snprintf(home, sizeof home, "%s", make_folder("filled"));
    snprintf(folder, sizeof folder, "%s/results", home);
    snprintf(words, sizeof words, "compare @cornell --size 256x192 --frames 1 --spp 1 --quiet");
    for (int i = 0; i < 8; i++) strcat(words, " --gi none");
    pid_t child = start(words, folder);
    int status = 0;
    for (int i = 0; i < 60000 * test_time_factor() && !has_entry(home, ".tmp-"); i++)
        test_pause_ms(1);
    kill(child, SIGTERM);
    assert_true(waitpid(child, &status, 0) == child);
    CHECK(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    CHECK(!has_entry(home, ".tmp-") && !file_exists(folder));
}
