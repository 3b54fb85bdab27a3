// --tonemap: the tone curve of displayed images, in each command that writes some.
#include "cli/program.h"

#include "image/exr.h"
#include "image/png_file.h"
#include "image/tonemap.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define EV "8"

// The PNG has the curve's values of the EXR's radiance, to half a step of its eight bits.
static void check_curve(const char *exr, const char *png, enum tonemap_curve curve)
{
    struct image radiance = { 0 }, expected = { 0 }, shown = { 0 };
    assert_true(exr_read(test_host(), exr, NULL, &radiance));
    assert_true(image_tonemap(&expected, test_host(), &radiance, 8.0f, curve));
    assert_true(png_read(test_host(), png, &shown));
    for (int i = 0; i < shown.width * shown.height * 3; i++) {
        const double error = srgb_encode(shown.pixels[i]) - srgb_encode(expected.pixels[i]);
        if (fabs(error) > 0.51 / 255.0) fail_msg("%s: value %d: error %g", png, i, error);
    }
    image_finish(&radiance, test_host());
    image_finish(&expected, test_host());
    image_finish(&shown, test_host());
}

static void check_command_curves(const char *words)
{
    static const char *const names[TONEMAP_COUNT] = { "neutral", "agx", "linear" };
    const char *exr = path_of("radiance.exr");
    run_expect(0, words, "-o", exr, NULL);
    for (int i = 0; i < TONEMAP_COUNT; i++) {
        const char *png = path_of("shown.png");
        run_expect(0, words, "--tonemap", names[i], "-o", png, NULL);
        check_curve(exr, png, (enum tonemap_curve)i);
    }
}

TEST(images_of_the_path_tracer_have_the_curve)
{
    check_command_curves("reference @cornell --size 24x18 --spp 2 --quiet --exposure " EV);
}

TEST(images_of_frames_have_the_curve)
{
    require_device();
    check_command_curves("render @cornell --size 24x18 --quiet --exposure " EV);
}

TEST(a_frame_option_is_the_same_curve)
{
    require_device();
    const char *a = path_of("a.png"), *b = path_of("b.png");
    run_expect(0, "render @cornell --size 24x18 --quiet --tonemap agx -o", a, NULL);
    run_expect(0, "render @cornell --size 24x18 --quiet", "--frame-options",
               "shadow_size=2048,tonemap=agx", "-o", b, NULL);
    CHECK(files_are_equal(a, b));
}

// By highlights: darker, for the ceiling at the light. A frame option does the same.
static double exposure_of(const char *words)
{
    json_t *result =
        run_json(run_expect(0, words, "--json", "--quiet", "-o", path_of("metered.exr"), NULL));
    const double ev = json_number_value(json_object_get(result, "exposure_ev"));
    json_decref(result);
    return ev;
}

TEST(highlights_are_metered_in_images_of_both)
{
    require_device();
#define LIT "@cornell:light=point --size 48x36 "
    const double mean = exposure_of("render " LIT "--exposure mean");
    const double bright = exposure_of("render " LIT "--exposure highlights");
    CHECK(bright > mean + 0.2 && bright <= mean + 3.001);
    CHECK(exposure_of("render " LIT) == mean);
    CHECK(exposure_of("render " LIT "--frame-options metering=highlights") == bright);
    CHECK(exposure_of("reference " LIT "--spp 4 --exposure highlights") >
          exposure_of("reference " LIT "--spp 4") + 0.2);
}

TEST(wrong_rules_of_exposure_are_refused)
{
    require_device();
    const struct run *r = run_expect(2, "render @cornell --exposure bright", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "mean highlights"));
    r = run_expect(2, "render @cornell --exposure mean --frame-options", "metering=highlights",
                   NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "choose one"));
}

TEST(wrong_curves_are_refused)
{
    require_device();
    const struct run *r = run_expect(2, "render @cornell --tonemap aces", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "neutral agx linear"));
    check_one_error_line(run_expect(2, "reference @cornell --tonemap agx,linear", NULL));
    r = run_expect(2, "render @cornell --tonemap agx --frame-options", "tonemap=linear", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "choose one"));
}
