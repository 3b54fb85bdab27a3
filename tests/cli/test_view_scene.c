// view: changes of the scene, in the image, undone, in session files.
#include "cli/view_run.h"

TEST(light_of_an_object_that_moved_is_complete_when_the_image_has_settled)
{
    require_display();
    view(CORNELL SMALL " --gi drt:quality=low",
         "settle\nsave first.png\ntab Inspect\nchoose instance 5\nwait 1\ndrag x 40 0\nsettle\n"
         "save moved.png\ngi drt:quality=low,update=wait\nsettle\nsave waited.png\n");
    check_differ("first.png", "moved.png");
    check_equal("moved.png", "waited.png");
}

// ---- lights

static double energy_in(const char *path)
{
    json_t *errors = json_load_file(path, 0, NULL);
    const double energy = json_number_value(json_object_get(errors, "energy"));
    json_decref(errors);
    return energy;
}

TEST(a_removed_light_gives_no_light)
{
    require_display();
    view(CORNELL SMALL " --exposure 9 --gi lpv:dim=16",
         "settle\nsave first.png\nlight 0 remove\nsettle\nsave removed.png\n"
         "fails light 0 1\nfails light 0 remove\nsays there is no light 0\n"
         "session write a.json\nundo\nsettle\nsave last.png\nredo\nsettle\nsave again.png\n");
    check_equal("first.png", "last.png");
    check_equal("removed.png", "again.png");
    CHECK(mean_of("removed.png") < 0.01 * mean_of("first.png"));
    view(CORNELL SMALL " --session a.json",
         "settle\nsave loaded.png\nfails light 0 1\nsession write b.json\n");
    check_equal("removed.png", "loaded.png");
    check_equal("a.json", "b.json");
}

// The scene's light has the index 0, and keeps that when another is removed.
TEST(lights_are_removed_in_the_panel)
{
    require_display();
    view(CORNELL SMALL " --exposure 9",
         "settle\nsave first.png\ntab Light\nclick point\nwait 2\nclick spot\nwait 2\n"
         "light 1 remove\nlight 2 remove\nsettle\nsave last.png\nsession write a.json\n"
         "click Remove light\nwait 2\nsettle\nsave dark.png\n");
    check_equal("first.png", "last.png");
    CHECK(mean_of("dark.png") < 0.01 * mean_of("first.png"));
    json_t *session = json_load_file("a.json", 0, NULL);
    CHECK(json_array_size(json_object_get(session, "lights")) == 0);
    json_decref(session);
}

#define TWO_LIGHTS CORNELL SMALL " --exposure 9 --gi lpv --light point:1.5,2,1.5:3,3,3"
TEST(the_command_and_the_reference_are_without_a_removed_light)
{
    require_display();
    check_command(TWO_LIGHTS, "light 0 remove\n");
    view(TWO_LIGHTS, "light 0 remove\nsplit reference\nsettle\nsamples 16\nerrors errors.json\n");
    const double energy = energy_in("errors.json");
    if (energy < 0.7 || energy > 1.4) fail_msg("the energy is %g", energy);
}
