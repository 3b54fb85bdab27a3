// view: what is changed is undone, kept in sessions, and survives other scenes and a lost device.
#include "cli/view/view_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
