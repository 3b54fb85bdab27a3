// view: scripts under a virtual display.
#include "cli/view_run.h"

#include "image/exr.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the window

TEST(without_a_display_one_line_names_the_remedy)
{
    enter_folder();
    require_device();
    unsetenv("DISPLAY");
    for (int i = 0; i < 2; i++) {
        const struct run *r = run_expect(1, CORNELL, "--frames", "1", NULL);
        check_one_error_line(r);
        if (!strstr(r->err, "set DISPLAY") || !strstr(r->err, "afterglow render"))
            fail_msg("no remedy: %s", r->err);
        setenv("DISPLAY", ":9876", 1);
    }
}

TEST(each_tab_is_shown)
{
    static const char *const tabs[] = { "View", "Light", "Method", "Compare", "Cost", "Inspect" };
    enum { TABS = sizeof tabs / sizeof *tabs };
    char script[1024] = "settle\n", names[TABS][32];
    require_display();
    for (int i = 0; i < TABS; i++) {
        const size_t used = strlen(script);
        snprintf(names[i], sizeof names[i], "tab-%s.png", tabs[i]);
        snprintf(script + used, sizeof script - used, "tab %s\nscreenshot %s\n", tabs[i], names[i]);
    }
    view(CORNELL SMALL " --gi lpv:dim=16", script);
    for (int i = 0; i < TABS; i++) {
        check_size(names[i], 640, 480);
        for (int k = 0; k < i; k++)
            if (files_are_equal(names[i], names[k]))
                fail_msg("%s and %s are the same image", names[i], names[k]);
    }
}

TEST(frames_are_shown_without_a_script)
{
    require_display();
    const struct run *r =
        run_expect(0, CORNELL SMALL, "--frames", "5", "--screenshot", "frames.png", NULL);
    CHECK_STRING(r->err, "");
    check_size("frames.png", 640, 480);
    CHECK(mean_of("frames.png") > 0.01);
}

TEST(the_last_frame_of_a_script_is_a_screenshot)
{
    require_display();
    view(CORNELL " --size 400x300 --scale 0.25 --screenshot end.png", "wait 2\n");
    check_size("end.png", 400, 300);
}

// ---- the command of a view

TEST(the_command_of_a_view_renders_its_image)
{
    require_display();
    check_command(CORNELL LEAST " --gi lpv:dim=16", "");
    check_command("view @atrium --quiet --gi vct:resolution=32+vo" LEAST, "look 2,3,1 -4,1,0\n");
    check_command("view @cornell:light=point --quiet --gi vct:resolution=16 --size 700x790 "
                  "--scale 0.1",
                  "tab Method\nclick debug view\nwait 2\nclick radiance\nwait 2\n"
                  "gi vct:resolution=32\n");
    check_command("view @maze --quiet --gi ambient+gtao" SMALL,
                  "camera far\nexposure 9.3\nlayer irradiance\n");
}

TEST(the_command_of_a_view_has_its_camera_and_lights)
{
    require_display();
    check_command(CORNELL LEAST " --fov 41.7", "light 0 0\nlight 0 1\n");
    check_command("view @maze --quiet --camera far --fov 33" LEAST
                  " --light point:-2.123456789,1.5,-4:900,800,700 --sky 1,2,3.123456789",
                  "");
    check_command("view @maze --quiet" LEAST " --eye -2.123456789,1.5,-4.000000123 --target "
                  "-3,1.5,-9 --fov 66.6666666 --light area:-2,2,-4:0,-1,-0.3:1,1:900,800,700 "
                  "--light spot:-2,2,-4:0,-1,-0.3:11.1:37.7:900,800,700",
                  "light 0 0\nlight 0 1\nmouse 10 10\nscroll 0 1\n");
}

// ---- one pixel

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

// ---- sizes, events

TEST(sizes_of_the_window_leave_the_image_as_it_was)
{
    require_display();
    view(CORNELL SMALL " --gi lpv:dim=16",
         "settle\nsave first.png\n"
         "size 1000x700\nsize 333x401\nwait 1\nsize 700x333\nwait 1\nsize 1280x800\nwait 1\n"
         "size 500x500\nsize 501x499\nsize 320x240\nscreenshot small.png\n"
         "size 800x600\nwait 1\nsize 640x480\nsettle\nsave last.png\nscreenshot large.png\n");
    check_equal("first.png", "last.png");
    check_size("small.png", 320, 240);
    check_size("large.png", 640, 480);
}

TEST(images_are_resized_and_removed_while_the_window_shows_them)
{
    require_display();
    view(CORNELL LEAST, "settle\nsave first.png\nsplit ambient\nwait 1\nscale 0.4\nwait 1\n"
                        "side on\nwait 2\nscale 0.5\nwait 1\nside off\nwait 1\n"
                        "scale 0.3\nwait 1\nsplit off\nwait 1\nlayer normal\nwait 1\n"
                        "scale 0.2\nlayer color\nsettle\nsave last.png\n");
    check_equal("first.png", "last.png");
}

TEST(random_events_end_without_a_message)
{
    require_display();
    view(CORNELL SMALL " --gi lpv:dim=16", "settle\nrandom 3 120\nwait 2\n");
}

// A camera that is at no place projects handles to no pixel.
TEST(a_camera_is_finite)
{
    require_display();
    view(CORNELL LEAST, "settle\nsave first.png\ntab Light\nchoose light 0\nwait 1\n"
                        "fails look nan,0,0 1,1,1\nsays finite\nfails look 1,1,1 inf,0,0\n"
                        "settle\nsave last.png\n");
    check_equal("first.png", "last.png");
}

// Half of a window of one pixel has no width.
TEST(an_image_without_width_has_no_handles)
{
    require_display();
    view(CORNELL LEAST, "split ambient\nside on\nlook 0,2,9 0,2,0\nsize 1x1\nwait 3\ntab Light\n"
                        "choose light 0\nwait 1\nfails drag z 9 9\nsays no handle\nwait 2\n");
}

TEST(a_click_switches_a_light_off)
{
    require_display();
    view(CORNELL SMALL " --exposure 9",
         "settle\nsave on.png\ntab Light\nclick on\nsettle\nsave off.png\n");
    CHECK(mean_of("on.png") > 0.01);
    CHECK(mean_of("off.png") < 0.5 * mean_of("on.png"));
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

TEST(changes_are_undone_and_done_again)
{
    require_display();
    view(
        CORNELL SMALL " --exposure 9 --gi lpv:dim=16",
        "settle\nsave first.png\nlight 0 0\nwait 1\ngi none\nwait 1\ntab Light\nclick point\nwait "
        "2\n"
        "settle\nsave changed.png\nundo\nundo\nundo\nsettle\nsave undone.png\n"
        "key control down\nkey shift down\npress z\npress z\npress z\nkey shift up\n"
        "key control up\nsettle\nsave again.png\nfails redo\nsays nothing to do again\nundo\nundo\n"
        "undo\nfails undo\nsays nothing to undo\n");
    check_equal("first.png", "undone.png");
    check_equal("changed.png", "again.png");
    CHECK(mean_of("changed.png") < 0.9 * mean_of("first.png"));
}

// The object with that index of a session's list.
static json_t *entry(json_t *session, const char *list, int index)
{
    size_t at;
    json_t *object;
    json_array_foreach(json_object_get(session, list), at, object)
    {
        if (json_integer_value(json_object_get(object, "index")) == index) return object;
    }
    fail_msg("%s: no %d", list, index);
    return NULL;
}

static double component(const json_t *object, const char *name, size_t i)
{
    return json_number_value(json_array_get(json_object_get(object, name), i));
}

// To the right in the image is +x; a sun's light comes from its handle.
TEST(handles_move_and_turn)
{
    require_display();
    view(CORNELL SMALL,
         "look 0,2,9 0,2,0\nsettle\nsave first.png\ntab Light\nchoose light 0\nwait 1\n"
         "drag x 40 0\nclick sun\nwait 1\ndrag turn 40 0\nsession write a.json\n"
         "tab Inspect\nchoose instance 0\nwait 1\ndrag y 0 -30\nsettle\n"
         "save moved.png\nsession write b.json\nundo\nundo\nundo\nundo\nsettle\n"
         "save last.png\n");
    json_t *a = json_load_file("a.json", 0, NULL), *b = json_load_file("b.json", 0, NULL);
    assert_true(a && b);
    CHECK(component(entry(a, "lights", 0), "position", 0) > 0.2);
    CHECK_NEAR(component(entry(a, "lights", 0), "position", 1), 5.188, 0.01);
    CHECK(component(entry(a, "lights", 1), "direction", 0) < 0.1);
    CHECK(json_array_size(json_object_get(a, "instances")) == 0);
    CHECK(component(entry(b, "instances", 0), "world_from_mesh", 13) > 0.1);
    json_decref(a);
    json_decref(b);
    check_equal("first.png", "last.png");
    if (files_are_equal("first.png", "moved.png")) fail_msg("nothing has moved");
}

// A line of a script that reads a session with a text, which must be refused with a sentence.
static void add_refused(char script[1024], const char *text, const char *sentence)
{
    static int count;
    char name[32];
    const size_t used = strlen(script);
    snprintf(name, sizeof name, "wrong-%d.json", count++);
    write_file(name, text, strlen(text));
    snprintf(script + used, 1024 - used, "fails session read %s\nsays %s\n", name, sentence);
}

#define SESSION "{\"afterglow_session\": 1, \"scene\": \"@cornell:light=point\", "
TEST(a_session_gives_the_view_again)
{
    require_display();
    view(CORNELL SMALL " --gi lpv:dim=16",
         "look 0.5,2,8 0,2,0\nlight 0 0\ntab Light\nclick spot\nexposure 9\nlayer irradiance\n"
         "gi lpv:dim=16+vo\nsplit ambient\nsettle\nsave saved.png\nsession write a.json\n");
    view(CORNELL SMALL " --session a.json", "settle\nsave loaded.png\nsession write b.json\n");
    check_equal("saved.png", "loaded.png");
    check_equal("a.json", "b.json");
    view(CORNELL SMALL " --gi none", "session read a.json\nsettle\nsave read.png\n");
    check_equal("saved.png", "read.png");
}

TEST(a_session_that_is_wrong_changes_nothing)
{
    char script[1024] = "settle\nsave first.png\n";
    require_display();
    add_refused(script, "{\"a\": ", "wrong-0.json: line 1: ");
    add_refused(script, "[]", "it is no session file");
    add_refused(script, "{\"afterglow_session\": 1, \"scene\": \"@atrium\"}",
                "it belongs to: afterglow view @atrium --session wrong-2.json");
    add_refused(script, SESSION "\"gl\": 1}", "unknown member gl: did you mean gi?");
    add_refused(script, SESSION "\"lights\": [{\"index\": 3}]}", "light: the scene has no light");
    add_refused(script, SESSION "\"gi\": \"lvp\", \"lights\": [{\"index\": 0, \"on\": false}]}",
                "did you mean lpv");
    strcat(script, "fails session write missing/a.json\nsays missing/a.json\n"
                   "drop wrong-5.json\nsettle\nsave last.png\n");
    view(CORNELL SMALL, script);
    check_equal("first.png", "last.png");
    check_fails(CORNELL LEAST " --session wrong-3.json", "wait 1\n", "unknown member gl");
}

// The window goes while a bake runs: what is finished is kept for the next one.
TEST(a_bake_is_cancelled_with_the_window_and_goes_on_later)
{
    require_display();
    setenv("AFTERGLOW_CACHE", make_folder("bakes"), 1);
    view(CORNELL LEAST " --gi lpv:dim=8,cascades=1",
         "settle\nsave before.png\ngi radiosity\nwait 1\n");
    view(CORNELL LEAST, "gi radiosity:texels=2048,rays=16\nsettle\nsave baked.png\nlayer indirect\n"
                        "settle\nsave indirect.png\n");
    CHECK(mean_of("indirect.png") > 0.01);
}

// A broken file leaves the scene that is shown.
TEST(other_scenes_open_in_the_window)
{
    require_display();
    view(CORNELL LEAST, "settle\nsave first.png\nsession write a.json\ndrop missing.glb\nwait 3\n"
                        "settle\nsave kept.png\nopen @maze\nsettle\nsave other.png\n"
                        "open a.json\nsettle\nsave last.png\n");
    check_equal("first.png", "kept.png");
    check_equal("first.png", "last.png");
    if (files_are_equal("first.png", "other.png")) fail_msg("the other scene is not shown");
    view("view a.json --quiet" LEAST, "settle\nsave file.png\n");
    check_equal("first.png", "file.png");
}

TEST(a_flight_is_recorded_to_numbered_images)
{
    require_display();
    view(CORNELL LEAST, "fails path record flight\nsays the camera's path has no keys\n"
                        "look 0,2,9 0,2,0\nsettle\nsave first.png\npath add\nlook 1,2,8 0,2,0\n"
                        "settle\nsave last.png\npath add\npath every 0.5 4\npath record flight\n"
                        "fails path record missing/flight\nsays missing/flight\n");
    check_equal("first.png", "flight/00000.png");
    check_equal("last.png", "flight/00002.png");
    CHECK(!file_exists("flight/00003.png"));
}

TEST(a_lost_device_leaves_a_session)
{
    require_display();
    check_fails(CORNELL LEAST " --gi lpv:dim=16",
                "light 0 0\nsettle\nsave lost.png\nlose\nwait 2\n",
                "--session afterglow-rescued.json");
    view(CORNELL LEAST " --session afterglow-rescued.json", "settle\nsave rescued.png\n");
    check_equal("lost.png", "rescued.png");
}

// ---- wrong scripts

TEST(a_line_that_fails_is_named)
{
    require_display();
    check_fails(CORNELL LEAST,
                "# first\n\nfails frobnicate 1\nsays script.txt:3: unknown command frobnicate\n"
                "fails gi lvp\nsays did you mean lpv\nwait 2\n"
                "fails save missing/a.png\nsays missing/a.png\nclick no such label\n",
                "script.txt:10: no element is shown with the label no such label");
    check_fails(CORNELL LEAST, "screenshot missing/a.png\nwait 1\n", "script.txt:1: ");
    check_fails(CORNELL LEAST, "fails wait 1\n", "script.txt:1: the line did not fail");
}

TEST(files_that_cannot_be_used_are_named)
{
    require_display();
    const struct run *r = run_expect(1, CORNELL LEAST, "--script", "missing.txt", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "cannot read missing.txt"));
    r = run_expect(1, CORNELL LEAST, "--frames", "2", "--screenshot", "missing/a.png", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "missing/a.png"));
}
