// diff: known errors, and files that cannot be compared.
#include "cli/program.h"

#include "image/exr.h"
#include "image/png_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 8, HEIGHT = 4 };

// An image of `value` with `first` as first pixel.
static const char *write_exr(const char *name, int width, float value, float first)
{
    struct image color = { 0 }, depth = { 0 };
    assert_true(image_init(&color, test_host(), width, HEIGHT, 3));
    assert_true(image_init(&depth, test_host(), width, HEIGHT, 1));
    for (int i = 0; i < 3 * width * HEIGHT; i++) color.pixels[i] = i < 3 ? first : value;
    for (int i = 0; i < width * HEIGHT; i++) depth.pixels[i] = 2 * value;
    const struct exr_layer layers[] = { { "color", &color }, { "depth", &depth } };
    const char *path = test_path(name);
    assert_true(exr_write(test_host(), path, layers, 2, NULL, 0));
    image_finish(&color, test_host());
    image_finish(&depth, test_host());
    return path;
}

static double metric(const json_t *document, const char *key)
{
    const json_t *value = json_object_get(document, key);
    if (!json_is_number(value)) fail_msg("no number %s", key);
    return json_number_value(value);
}

TEST(a_constant_difference_has_the_errors_of_its_size)
{
    char a[300], b[300];
    snprintf(a, sizeof a, "%s", write_exr("a.exr", WIDTH, 0.75f, 0.75f));
    snprintf(b, sizeof b, "%s", write_exr("b.exr", WIDTH, 0.5f, 0.5f));
    json_t *d = run_json(run_expect(0, "diff --json", a, b, NULL));
    CHECK_NEAR(metric(d, "mse"), 0.0625, 1e-9);
    CHECK_NEAR(metric(d, "mae"), 0.25, 1e-9);
    CHECK_NEAR(metric(d, "psnr"), -10 * log10(0.0625), 1e-6);
    CHECK_NEAR(metric(d, "relmse"), 0.0625 / (0.25 + 0.01 * 0.25), 1e-6);
    CHECK(metric(d, "ssim") < 1 && metric(d, "flip") > 0.01 && metric(d, "flip_hdr") > 0.01);
    CHECK_NEAR(metric(d, "exposure_ev"), log2(0.5 / (1.2 * 0.18)), 0.012); // a bin
    CHECK(!json_object_get(d, "pixels"));
    assert_int_equal((int)metric(d, "width"), WIDTH);
    assert_int_equal((int)metric(d, "height"), HEIGHT);
    CHECK_NEAR(json_number_value(json_array_get(json_object_get(d, "mean_a"), 2)), 0.75, 1e-9);
    CHECK_NEAR(json_number_value(json_array_get(json_object_get(d, "mean_b"), 0)), 0.5, 1e-9);
    json_decref(d);
    // The table shows the same values.
    const struct run *r = run_expect(0, "diff", a, b, NULL);
    CHECK(strstr(r->out, "mse     0.0625\n") && strstr(r->out, "mae     0.25\n"));
    CHECK(strstr(r->out, "\nssim    0.") && strstr(r->out, "\nflip    0."));
}

TEST(equal_images_have_no_error_and_no_finite_psnr)
{
    const char *a = write_exr("same.exr", WIDTH, 3.0f, 1.0f);
    json_t *d = run_json(run_expect(0, "diff --json", a, a, NULL));
    assert_true(metric(d, "mse") == 0 && metric(d, "mae") == 0 && metric(d, "relmse") == 0);
    CHECK(json_is_null(json_object_get(d, "psnr")));
    assert_true(metric(d, "ssim") == 1 && metric(d, "flip") == 0 && metric(d, "flip_hdr") == 0);
    json_decref(d);
}

TEST(a_layer_is_compared_by_name)
{
    char a[300], b[300];
    snprintf(a, sizeof a, "%s", write_exr("la.exr", WIDTH, 1.0f, 1.0f));
    snprintf(b, sizeof b, "%s", write_exr("lb.exr", WIDTH, 3.0f, 3.0f));
    json_t *d = run_json(run_expect(0, "diff --json --layer depth", a, b, NULL));
    CHECK_NEAR(metric(d, "mae"), 4.0, 1e-6);
    json_decref(d);
    const struct run *r = run_expect(1, "diff --layer indirect", a, b, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "indirect") && strstr(r->err, "color") && strstr(r->err, "depth"));
}

TEST(messages_name_images_that_cannot_be_compared)
{
    char a[300], b[300], bad[300];
    snprintf(a, sizeof a, "%s", write_exr("wide.exr", 2 * WIDTH, 1.0f, 1.0f));
    snprintf(b, sizeof b, "%s", write_exr("narrow.exr", WIDTH, 1.0f, 1.0f));
    snprintf(bad, sizeof bad, "%s", write_exr("nan.exr", WIDTH, 1.0f, NAN));
    const struct run *r = run_expect(1, "diff", a, b, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "16x4") && strstr(r->err, "8x4"));
    r = run_expect(1, "diff", b, bad, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "nan.exr") && strstr(r->err, "1 of its pixels"));
}

TEST(the_error_map_is_dark_where_images_agree)
{
    char a[300], b[300], map[300];
    snprintf(a, sizeof a, "%s", write_exr("map-a.exr", WIDTH, 1.0f, 9.0f));
    snprintf(b, sizeof b, "%s", write_exr("map-b.exr", WIDTH, 1.0f, 1.0f));
    snprintf(map, sizeof map, "%s", test_path("map.png"));
    run_expect(0, "diff --map", map, a, b, NULL);
    struct image image = { 0 };
    assert_true(png_read(test_host(), map, &image));
    assert_int_equal(image.width, WIDTH);
    vec3s bright = vec3_of(image.pixels[0], image.pixels[1], image.pixels[2]);
    const float *last = image_at(&image, WIDTH - 1, HEIGHT - 1);
    CHECK(luminance(bright) > 2 * luminance(vec3_of(last[0], last[1], last[2])));
    image_finish(&image, test_host());
}

TEST(a_failed_comparison_writes_no_map)
{
    char a[300], b[300], map[300];
    snprintf(a, sizeof a, "%s", write_exr("f-wide.exr", 2 * WIDTH, 1.0f, 1.0f));
    snprintf(b, sizeof b, "%s", write_exr("f-narrow.exr", WIDTH, 1.0f, 1.0f));
    snprintf(map, sizeof map, "%s/map.png", make_folder("maps"));
    run_expect(1, "diff --map", map, a, b, NULL);
    CHECK(!file_exists(map));
}

TEST(both_images_have_the_same_exposure)
{
    char a[300], b[300];
    snprintf(a, sizeof a, "%s", write_exr("ea.exr", WIDTH, 4.0f, 2.0f));
    snprintf(b, sizeof b, "%s", write_exr("eb.exr", WIDTH, 2.0f, 4.0f));
    json_t *automatic = run_json(run_expect(0, "diff --json", a, b, NULL));
    json_t *dark = run_json(run_expect(0, "diff --json --exposure 12", a, b, NULL));
    CHECK_NEAR(metric(dark, "exposure_ev"), 12.0, 1e-9);
    CHECK(metric(dark, "flip") < 0.1 * metric(automatic, "flip"));
    CHECK(metric(dark, "mse") == metric(automatic, "mse"));
    CHECK(metric(dark, "flip_hdr") == metric(automatic, "flip_hdr"));
    json_decref(automatic);
    json_decref(dark);
}

// As the help of diff shows it: half of this view is sky.
TEST(a_reference_with_depth_masks_the_sky)
{
    char reference[300];
    snprintf(reference, sizeof reference, "%s", test_path("masked-reference.exr"));
    run_expect(0, "reference @diagonal --spp 1 --size 32x32 --aov color,depth -o", reference, NULL);
    json_t *masked =
        run_json(run_expect(0, "diff --json --mask depth", reference, reference, NULL));
    CHECK(metric(masked, "pixels") > 0 && metric(masked, "pixels") < 32 * 32);
    json_decref(masked);
    const char *help = run_expect(0, "diff --help", NULL)->out;
    CHECK(strstr(help, "afterglow reference house.glb --aov color,depth -o reference.exr\n"
                       "  afterglow diff lpv.exr reference.exr --mask depth\n"));
}

TEST(a_mask_and_ignored_pixels_are_excluded)
{
    char a[300], b[300];
    snprintf(a, sizeof a, "%s", write_exr("ma.exr", WIDTH, 1.0f, NAN));
    snprintf(b, sizeof b, "%s", write_exr("mb.exr", WIDTH, 1.0f, 1.0f));
    const struct run *r = run_expect(1, "diff --json --mask depth", a, b, NULL);
    check_one_error_line(r);
    r = run_expect(0, "diff --json --ignore-nan --mask depth", a, b, NULL);
    CHECK(strstr(r->err, "ma.exr") && strstr(r->err, "1 of its pixels"));
    json_t *d = run_json(r);
    assert_int_equal((int)metric(d, "pixels"), WIDTH * HEIGHT - 1);
    CHECK(metric(d, "mse") == 0 && metric(d, "flip") == 0);
    json_decref(d);
    // Depth is 2 everywhere, so no pixel exceeds 2.
    r = run_expect(1, "diff --ignore-nan --mask depth=2", a, b, NULL);
    check_one_error_line(r);
    r = run_expect(1, "diff --mask indirect", a, b, NULL);
    CHECK(strstr(r->err, "indirect"));
    run_expect(0, "diff --ignore-nan --mask=depth=1.5", a, b, NULL);
}

TEST(each_metric_has_its_map)
{
    static const char *const names[] = { "mae", "mse", "relmse", "ssim", "flip", "flip_hdr" };
    char a[300], b[300], map[300], words[64];
    snprintf(a, sizeof a, "%s", write_exr("pa.exr", WIDTH, 1.0f, 9.0f));
    snprintf(b, sizeof b, "%s", write_exr("pb.exr", WIDTH, 2.0f, 1.0f));
    snprintf(map, sizeof map, "%s", test_path("metric.png"));
    for (int i = 0; i < 6; i++) {
        struct image image = { 0 };
        snprintf(words, sizeof words, "diff --metric %s --map", names[i]);
        run_expect(0, words, map, a, b, NULL);
        assert_true(png_read(test_host(), map, &image));
        assert_int_equal(image.height, HEIGHT);
        image_finish(&image, test_host());
    }
    run_expect(2, "diff --metric psnr --map", map, a, b, NULL);
}

TEST(options_for_radiance_are_wrong_usage_for_png)
{
    char png[300];
    struct image image = { 0 };
    assert_true(image_init(&image, test_host(), 8, 4, 3));
    snprintf(png, sizeof png, "%s", test_path("display.png"));
    assert_true(png_write(test_host(), png, &image));
    image_finish(&image, test_host());
    run_expect(2, "diff --exposure 3", png, png, NULL);
    run_expect(2, "diff --mask depth", png, png, NULL);
    run_expect(2, "diff --metric flip_hdr --map m.png", png, png, NULL);
    json_t *d = run_json(run_expect(0, "diff --json", png, png, NULL));
    CHECK(metric(d, "ssim") == 1 && !json_object_get(d, "flip_hdr"));
    json_decref(d);
}
