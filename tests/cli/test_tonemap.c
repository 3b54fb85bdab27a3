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
