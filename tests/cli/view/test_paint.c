// view: painted light in undo, in sessions, and on other texels.
#include "cli/view/view_run.h"

#include <string.h>

#define PAINTED CORNELL LEAST " --exposure 10 --gi radiosity:texels=4096,rays=16"
#define DAB     "paint 0,0,1.5 0,1,0 1.5 4000,2000,1000\n"

TEST(strokes_are_undone_and_in_sessions)
{
    require_display();
    view(PAINTED, "settle\nsave first.png\n" DAB "settle\nsave one.png\n"
                  "paint 1,0,2 0,1,0 1 0,0,9000\nsettle\nsave two.png\nsession write a.json\n"
                  "fails command lost.sh\nsays painted light\n"
                  "undo\nsettle\nsave back.png\nundo\nsettle\nsave last.png\nredo\nredo\nsettle\n"
                  "save again.png\npaint clear\nsettle\nsave clear.png\nundo\nsettle\n"
                  "save kept.png\n");
    check_differ("first.png", "one.png");
    check_differ("one.png", "two.png");
    check_equal("one.png", "back.png");
    check_equal("first.png", "last.png");
    check_equal("two.png", "again.png");
    check_equal("first.png", "clear.png");
    check_equal("two.png", "kept.png");
    CHECK(mean_of("two.png") > 1.1 * mean_of("first.png"));
    view(CORNELL LEAST " --session a.json", "settle\nsave loaded.png\nsession write b.json\n");
    check_equal("two.png", "loaded.png");
    check_equal("a.json", "b.json");
}

// A stroke of the mouse is one step.
TEST(a_stroke_of_the_mouse_is_undone_at_once)
{
    require_display();
    view(
        CORNELL " --size 480x480 --scale 0.5 --exposure 10 --gi radiosity:texels=4096,rays=16",
        "settle\nsave first.png\ntab Light\nclick Painted light\nwait 2\n"
        "click paint with the left button\nwait 2\nmouse 60 300\nwait 1\nbutton left down\nwait 1\n"
        "mouse 80 320\nwait 1\nmouse 90 350\nwait 1\nbutton left up\nwait 2\nsettle\n"
        "save painted.png\nsession write a.json\nundo\nsettle\nsave last.png\nfails undo\n"
        "says nothing to undo\n");
    check_equal("first.png", "last.png");
    check_differ("first.png", "painted.png");
    json_t *session = json_load_file("a.json", 0, NULL);
    CHECK(json_array_size(json_object_get(session, "paint")) > 2);
    json_decref(session);
}

TEST(paint_comes_again_with_other_texels)
{
    require_display();
    view(PAINTED, "settle\n" DAB "settle\nsave painted.png\ngi none\nsettle\nsays takes none\n"
                  "save none.png\nfails " DAB "says no light map\ncommand command.sh\n"
                  "gi radiosity:texels=2048,rays=16\nsettle\nsave other.png\npaint clear\nsettle\n"
                  "save dark.png\nundo\ngi radiosity:texels=4096,rays=16\nsettle\nsave last.png\n");
    check_equal("painted.png", "last.png");
    CHECK(mean_of("other.png") > 1.05 * mean_of("dark.png"));
    run_line("command.sh", "rendered.png");
    check_equal("none.png", "rendered.png");
}

TEST(paint_that_is_wrong_changes_nothing)
{
    static const char wrong[] = "{\"afterglow_session\": 1, \"paint\": [{\"position\": [0, 0, 0], "
                                "\"radius\": 1, \"lux\": [1, -1, 1]}]}";
    require_display();
    write_file("wrong.json", wrong, strlen(wrong));
    view(PAINTED, "settle\n" DAB "settle\nsave first.png\nfails session read wrong.json\n"
                  "says paint: lux\nfails paint 0,0,0 0,1,0 -1 1,1,1\nsays paint takes\n"
                  "settle\nsave last.png\n");
    check_equal("first.png", "last.png");
}
