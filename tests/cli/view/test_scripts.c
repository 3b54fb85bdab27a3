// view: scripts under a virtual display.
#include "cli/view/view_run.h"

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
    check_command(CORNELL LEAST " --tonemap linear", "tonemap agx\n");
    check_command(CORNELL LEAST " --frame-options tonemap=agx", "exposure highlights\n");
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
