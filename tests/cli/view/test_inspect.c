// view: values of pixels, probes, painted light, and errors to the reference.
#include "cli/view/view_run.h"

#include "image/exr.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_layer(const json_t *pixel, const char *layer, int x, int y)
{
    struct image image;
    const json_t *values = json_object_get(pixel, layer);
    CHECK(exr_read(test_host(), "layers.exr", layer, &image));
    for (int c = 0; c < image.channels; c++) {
        const float *at = image.pixels + (size_t)image.channels * (size_t)(image.width * y + x);
        const json_t *value = json_is_array(values) ? json_array_get(values, (size_t)c) : values;
        CHECK(json_is_number(value));
        if (fabs(json_number_value(value) - (double)at[c]) > 1e-6 * fabs((double)at[c]))
            fail_msg("%s[%d] is %g, not %g", layer, c, json_number_value(value), (double)at[c]);
    }
    image_finish(&image, test_host());
}

// An image of one colour is exposed to middle grey.
static void check_exposure(const json_t *pixel)
{
    float color[3];
    const struct ag_image image = { 1, 1, 3, color };
    for (size_t i = 0; i < 3; i++)
        color[i] = (float)json_number_value(json_array_get(json_object_get(pixel, "color"), i));
    CHECK_NEAR(json_number_value(json_object_get(pixel, "ev")), ag_image_auto_exposure(&image),
               0.01);
}

TEST(a_pixel_has_the_values_of_rendered_layers)
{
    static const char *const layers[] = { "color",  "direct", "indirect", "specular", "irradiance",
                                          "albedo", "normal", "position", "depth" };
    require_display();
    view(CORNELL LEAST " --gi lpv:dim=8,cascades=1",
         "settle\ntab Inspect\nmouse 62 142\nsettle\ninspect pixel.json\n"
         "command command.sh\n");
    run_line("command.sh", "layers.exr --aov color,direct,indirect,specular,irradiance,albedo,"
                           "normal,position,depth,id");
    json_t *pixel = json_load_file("pixel.json", 0, NULL);
    assert_true(pixel);
    const int x = (int)json_integer_value(json_array_get(json_object_get(pixel, "pixel"), 0));
    const int y = (int)json_integer_value(json_array_get(json_object_get(pixel, "pixel"), 1));
    CHECK(x == 12 && y == 28); // at a fifth of the window's size
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) check_layer(pixel, layers[i], x, y);
    check_exposure(pixel);
    json_t *id = json_pack("[i, i]", (int)json_integer_value(json_object_get(pixel, "instance")),
                           (int)json_integer_value(json_object_get(pixel, "triangle")));
    json_object_set_new(pixel, "id", id);
    check_layer(pixel, "id", x, y);
    CHECK(json_string_length(json_object_get(pixel, "instance_name")) > 0);
    json_decref(pixel);
}

#define VIEW_PROBES "{\"afterglow_session\": 1, \"debug_view\": \"probes\"}"

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double irradiance_in(const char *path)
{
    json_t *pixel = json_load_file(path, 0, NULL);
    assert_true(pixel);
    const json_t *values = json_object_get(pixel, "irradiance");
    const double lux = json_number_value(json_array_get(values, 1));
    json_decref(pixel);
    return lux;
}

// Light of the balls over that of the debug view's, the median of pixels that the balls changed: a
// factor of pi is far outside of what edges and depths differ by.
static double balls_over_view(const char *without, const char *with, const char *view)
{
    enum { WIDTH = 118, HEIGHT = 440, MOST = WIDTH * HEIGHT };
    static double ratios[MOST];
    struct image a, b, c;
    int count = 0;
    CHECK(png_read(test_host(), without, &a));
    CHECK(png_read(test_host(), with, &b));
    CHECK(png_read(test_host(), view, &c));
    for (int i = 0; i < MOST; i++) {
        const size_t at = 3 * ((size_t)(i / WIDTH) * (size_t)a.width + (size_t)(i % WIDTH));
        double changed = 0, ball = 0, shown = 0;
        for (size_t k = 0; k < 3; k++) {
            changed += fabs((double)b.pixels[at + k] - (double)a.pixels[at + k]);
            ball += (double)b.pixels[at + k];
            shown += (double)c.pixels[at + k];
        }
        if (changed > 0.02 && ball > 0.02 && shown > 0.02) ratios[count++] = ball / shown;
    }
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&c, test_host());
    if (count < 500) fail_msg("the balls cover %d pixels", count);
    qsort(ratios, (size_t)count, sizeof *ratios, compare_doubles);
    return ratios[count / 2];
}

// The probes' switch sets an option; painted light arrives at the pixel under the brush.
TEST(probes_are_balls_and_light_is_painted)
{
    char command[1024] = "";
    require_display();
    write_file("probes.json", VIEW_PROBES, strlen(VIEW_PROBES));
    view(CORNELL " --size 480x480 --scale 1 --exposure 8 --gi radiosity:texels=4096,rays=16",
         "mouse 60 240\nsettle\ninspect dark.json\ntab Inspect\nmouse 470 470\nwait 2\n"
         "screenshot without.png\nclick probes as balls\nsettle\nmouse 470 470\nwait 2\n"
         "screenshot with.png\nclick probes as balls\nsession read probes.json\nsettle\n"
         "mouse 470 470\nwait 2\nscreenshot view.png\nlayer color\ncommand command.sh\n"
         "tab Light\nclick Painted light\nwait 2\nclick paint with the left button\nwait 2\n"
         "click brush radius (m)\nwait 2\n"
         "mouse 60 240\nwait 1\nbutton left down\nwait 1\nbutton left up\nsettle\n"
         "inspect bright.json\n");
    FILE *file = fopen("command.sh", "r");
    CHECK(file && fgets(command, sizeof command, file));
    fclose(file);
    if (!strstr(command, "rays=16,probes=true")) fail_msg("no probes: %s", command);
    const double ratio = balls_over_view("without.png", "with.png", "view.png");
    if (ratio < 0.8 || ratio > 1.25) fail_msg("balls have %g of the debug view's light", ratio);
    const double added = irradiance_in("bright.json") - irradiance_in("dark.json");
    // The brush is metres wide: 1000 lux at its middle, and what returns from other surfaces.
    if (added < 900 || added > 1500) fail_msg("a brush of 1000 lux adds %g lux", added);
}

// The energy of lpv in the box is some percent off; a wrong factor of radiance is beyond.
TEST(errors_are_those_to_the_reference)
{
    require_display();
    view(CORNELL SMALL " --gi lpv:dim=16 --split reference",
         "fails errors early.json\nsays no errors are measured\n"
         "settle\nsamples 32\nerrors errors.json\ngi none\nsettle\nsamples 64\nwait 2\n"
         "errors none.json\n");
    json_t *lpv = json_load_file("errors.json", 0, NULL),
           *none = json_load_file("none.json", 0, NULL);
    assert_true(lpv && none);
    const double energy = json_number_value(json_object_get(lpv, "energy"));
    if (energy < 0.85 || energy > 1.15) fail_msg("the energy of lpv is %g", energy);
    CHECK(json_integer_value(json_object_get(lpv, "samples")) >= 32);
    CHECK(json_number_value(json_object_get(none, "energy")) < 0.8 * energy);
    CHECK(json_number_value(json_object_get(none, "flip")) >
          json_number_value(json_object_get(lpv, "flip")));
    json_decref(lpv);
    json_decref(none);
}
