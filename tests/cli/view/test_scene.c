// view: changes of the scene, in the image, undone, in session files.
#include "cli/view/view_run.h"

#include "image/exr.h"

#include <stdio.h>
#include <string.h>

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

// ---- the environment

// A map of 8 × 4 texels in which each column has another radiance.
static void write_map(const char *path)
{
    struct image image;
    assert_true(image_init(&image, test_host(), 8, 4, 3));
    for (int i = 0; i < 8 * 4 * 3; i++) image.pixels[i] = (float)(20 * (1 + i / 3 % 8));
    assert_true(exr_write(test_host(), path, &(struct exr_layer){ "color", &image }, 1, NULL, 0));
    image_finish(&image, test_host());
}

#define OUTSIDE "look 0,2.73,16 0,2.73,0\n"
TEST(an_environment_is_chosen_turned_and_undone)
{
    require_display();
    write_map("map.exr");
    view(CORNELL SMALL " --exposure 11",
         OUTSIDE "settle\nsave first.png\nenvironment file map.exr\nsettle\nsave map.png\n"
                 "environment rotation 90\nsettle\nsave turned.png\nenvironment strength 2\n"
                 "settle\nsave strong.png\nfails environment file missing.exr\n"
                 "says missing.exr\nfails environment strength -1\nsays strength\n"
                 "session write a.json\nundo\nsettle\nsave back.png\nundo\nundo\nsettle\n"
                 "save last.png\nredo\nsettle\nsave again.png\nenvironment none\nsettle\n"
                 "save none.png\nfails environment map.exr\nsays environment takes\n");
    check_equal("first.png", "last.png");
    check_equal("map.png", "again.png");
    check_equal("turned.png", "back.png");
    check_equal("first.png", "none.png");
    check_differ("map.png", "turned.png");
    CHECK(mean_of("map.png") > 1.2 * mean_of("first.png"));
    CHECK(mean_of("strong.png") > 1.2 * mean_of("turned.png"));
    view(CORNELL SMALL " --session a.json", "settle\nsave loaded.png\nsession write b.json\n");
    check_equal("strong.png", "loaded.png");
    check_equal("a.json", "b.json");
}

TEST(a_session_whose_environment_is_missing_changes_nothing)
{
    static const char session[] = "{\"afterglow_session\": 1, \"lights\": [{\"index\": 0, "
                                  "\"on\": false}], \"environment\": {\"source\": \"file\", "
                                  "\"file\": \"missing.exr\"}}";
    static const char wrong[] = "{\"afterglow_session\": 1, \"environment\": {\"source\": 3}}";
    require_display();
    write_file("missing.json", session, strlen(session));
    write_file("wrong.json", wrong, strlen(wrong));
    view(CORNELL SMALL, "settle\nsave first.png\nfails session read missing.json\n"
                        "says missing.exr\nfails session read wrong.json\nsays environment: \n"
                        "settle\nsave last.png\n");
    check_equal("first.png", "last.png");
}

TEST(the_command_and_the_reference_have_the_environment)
{
    require_display();
    write_map("map.exr");
    check_command(CORNELL LEAST " --exposure 6 --gi lpv:dim=16",
                  OUTSIDE "environment file map.exr\nenvironment rotation -40\n"
                          "environment strength 1.7\n");
    check_command(CORNELL LEAST " --exposure 10 --environment sun-sky:elevation=20,azimuth=33",
                  OUTSIDE "environment rotation 40\n");
    check_command(CORNELL LEAST " --exposure 6 --environment map.exr:strength=3",
                  OUTSIDE "environment none\n");
    view(CORNELL SMALL " --exposure 6",
         OUTSIDE "environment file map.exr\nenvironment strength 20\nsplit reference\nsettle\n"
                 "samples 16\nerrors errors.json\n");
    // Indirect light of the box is missing; without the environment it is far above 1.
    const double energy = energy_in("errors.json");
    if (energy < 0.6 || energy > 1.2) fail_msg("the energy is %g", energy);
}

static void copy_file(const char *from, const char *to)
{
    static char bytes[1 << 20];
    FILE *file = fopen(from, "rb");
    if (!file) fail_msg("cannot read %s", from);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    write_file(to, bytes, size);
}

// The environment of a file is in it: no option says another use of it.
TEST(the_command_refuses_another_use_of_a_files_environment)
{
    require_display();
    copy_file(IMAGE_LIGHT, "light.gltf");
    view("view light.gltf --quiet" LEAST,
         "settle\nsave first.png\ncommand command.sh\nenvironment rotation 50\nsettle\n"
         "fails command no.sh\nsays there is no option for another use of the environment\n"
         "environment none\nsettle\nfails command no.sh\nsave none.png\n"
         "environment scene\nenvironment rotation 0\nsettle\nsave last.png\n"
         "command command.sh\n");
    check_equal("first.png", "last.png");
    check_differ("first.png", "none.png");
    run_line("command.sh", "rendered.png");
    check_equal("first.png", "rendered.png");
}
