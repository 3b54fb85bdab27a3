// Wrong input: exit status, one line that names the cause, no files left.
#include "cli/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

struct wrong {
    const char *words, *names; // what the line must name
};

static void check_wrong(const struct wrong *cases, size_t count, int status)
{
    char folder[256], image[300];
    static int number;
    char name[32];
    snprintf(name, sizeof name, "wrong-%d", number++);
    snprintf(folder, sizeof folder, "%s", make_folder(name));
    snprintf(image, sizeof image, "%s/out.exr", folder);
    for (size_t i = 0; i < count; i++) {
        bool renders =
            strncmp(cases[i].words, "render @", 8) == 0 && !strstr(cases[i].words, " -o");
        const struct run *r = renders ? run_expect(status, cases[i].words, "-o", image, NULL)
                                      : run_expect(status, cases[i].words, NULL);
        check_one_error_line(r);
        if (!strstr(r->err, cases[i].names))
            fail_msg("%s: does not name \"%s\": %s", cases[i].words, cases[i].names, r->err);
        assert_int_equal(count_files(folder), 0);
    }
}

#define CHECK_WRONG(cases, status) check_wrong(cases, sizeof(cases) / sizeof((cases)[0]), status)

TEST(wrong_commands_and_arguments_are_wrong_usage)
{
    static const struct wrong cases[] = {
        { "", "--help" },
        { "rendr @cornell", "render" },
        { "vieww @cornell", "view" },
        { "view", "SCENE" },
        { "view @cornell --screenshot a.png", "--frames" },
        { "view @cornell --scale 9 --frames 1", "--scale" },
        { "reference @cornell @cornell", "@cornell" },
        { "render", "SCENE" },
        { "render @cornell @cornell", "@cornell" },
        { "info", "SCENE" },
        { "list extra", "extra" },
        { "list lvp", "did you mean lpv?" },
        { "list lpv vct", "vct" },
        { "help rendr", "did you mean render?" },
        { "render @cornell --gi lpv,steps=8", "did you mean lpv:steps=8?" },
        { "render @cornell --gi lpv,vo", "did you mean lpv+vo?" },
        { "render @cornell --gi lpv,vo:lines=4", "did you mean lpv+vo:lines=4?" },
        { "render @cornell --gi lpv:steps=8,vo", "did you mean lpv:steps=8+vo?" },
        { "diff a.png", "B" },
        { "diff a.png b.exr", "b.exr" },
        { "diff a.jpg b.png", "a.jpg" },
        { "diff a.png b.png --layer color", "--layer" },
        { "diff a.exr b.exr --map map.exr", "--map" },
    };
    CHECK_WRONG(cases, 2);
}

TEST(help_and_list_show_one_command_or_technique)
{
    char long_help[sizeof(((struct run *)0)->out)];
    snprintf(long_help, sizeof long_help, "%s", run_expect(0, "compare --help", NULL)->out);
    CHECK_STRING(run_expect(0, "help compare", NULL)->out, long_help);
    CHECK_STRING(run_expect(0, "compare -h", NULL)->out, long_help);
    const struct run *r = run_expect(0, "list ssao", NULL);
    CHECK(strstr(r->out, "\nssao: ") == r->out && !strstr(r->out, "\nvo: "));
    CHECK(strstr(r->out, "    radius=") && !strstr(r->out, "Devices"));
    CHECK(strstr(run_expect(0, "list @maze", NULL)->out, "    blocks="));
    json_t *scene = run_json(run_expect(0, "list maze --json", NULL));
    CHECK_STRING(json_string_value(json_object_get(scene, "name")), "@maze");
    json_decref(scene);
}

TEST(short_options_are_the_long_ones)
{
    require_device();
    const char *words = "render @cornell:light=point --size 16x16 --gi vo -o";
    const char *path = test_path("short.png");
    CHECK(run_expect(0, words, path, NULL)->err[0] != 0);
    CHECK_STRING(run_expect(0, words, path, "-q", NULL)->err, "");
    CHECK(strstr(run_expect(0, words, path, "-v", NULL)->err, "gbuffer"));
}

TEST(a_shader_folder_without_shaders_is_said)
{
    require_device();
    const char *words = "render @cornell:light=point --size 16x16 -o";
    setenv("AFTERGLOW_SHADER_DIR", "/nowhere", 1);
    const struct run *r = run_expect(0, words, test_path("shaders.png"), NULL);
    unsetenv("AFTERGLOW_SHADER_DIR");
    CHECK(strstr(r->err, "AFTERGLOW_SHADER_DIR /nowhere") && strstr(r->err, "embedded"));
}

TEST(a_missing_driver_names_the_package_that_brings_one)
{
    setenv("VK_DRIVER_FILES", "/nowhere.json", 1);
    setenv("VK_ICD_FILENAMES", "/nowhere.json", 1);
    const struct run *r = run_expect(1, "render @cornell -o", test_path("driver.png"), NULL);
    unsetenv("VK_DRIVER_FILES");
    unsetenv("VK_ICD_FILENAMES");
    check_one_error_line(r);
    CHECK(strstr(r->err, "mesa-vulkan-drivers"));
}

TEST(a_debug_view_of_another_technique_is_named)
{
    require_device();
    const char *words = "render @cornell:light=point --size 16x16 --debug-view lpv.cells -o";
    const struct run *r = run_expect(2, words, test_path("view.png"), NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "try --gi lpv"));
}

TEST(unknown_options_name_the_nearest)
{
    static const struct wrong cases[] = {
        { "render @cornell --sise 3x3", "--size" },
        { "render @cornell --exposur=3", "--exposure" },
        { "info @cornell --jsn", "--json" },
        { "info @cornell --size 3x3", "--size" }, // an option of another command
        { "list --jason", "--json" },
        { "diff a.png b.png --layr x", "--layer" },
        { "render @cornell --no-such-thing-at-all", "--help" },
    };
    CHECK_WRONG(cases, 2);
}

TEST(wrong_values_are_wrong_usage)
{
    static const struct wrong cases[] = {
        { "render @cornell --size 0x100", "--size" },
        { "render @cornell --size 100x0", "--size" },
        { "render @cornell --size 100000x100", "--size" },
        { "render @cornell --size 100x16385", "--size" },
        { "render @cornell --size 100", "--size" },
        { "render @cornell --size 100x100x100", "--size" },
        { "render @cornell --size -100x100", "--size" },
        { "render @cornell --size 99999999999999999999x100", "--size" },
        { "render @cornell --size", "--size" },
        { "render @cornell --frames 0", "--frames" },
        { "render @cornell --frames 1e3", "--frames" },
        { "render @cornell --fov 180", "--fov 180: it must be 0.001 to 179.999 degrees" },
        { "render @cornell --fov 0", "--fov 0: it must be 0.001 to 179.999 degrees" },
        { "render @cornell --fov 1e-5", "--fov 1e-5: it must be 0.001 to 179.999 degrees" },
        { "render @cornell --time nan", "--time" },
        { "render @cornell --time 1,5", "--time" },
        { "render @cornell --frames 3 --time-step 1e308", "--time-step" },
        { "render @cornell --exposure bright", "--exposure" },
        { "render @cornell --exposure inf", "--exposure" },
        { "render @cornell --seed -1", "--seed" },
        { "render @cornell --sky 1,2", "--sky" },
        { "render @cornell --sky 1,2,-3", "--sky" },
        { "render @cornell --eye 1,2,3", "--target" },
        { "render @cornell --target 1,2,3", "--eye" },
        { "render @cornell --eye 0,0,0 --target -0,0,0", "same point" },
        { "render @cornell --eye 1,2,3 --target 1,2,3", "--eye" },
        { "render @cornell --eye 1,2,x --target 1,2,3", "--eye" },
        { "render @cornell --camera main --eye 0,0,0 --target 1,2,3", "--camera" },
        { "render @cornell --quiet=yes", "--quiet" },
    };
    CHECK_WRONG(cases, 2);
}

TEST(wrong_lights_are_wrong_usage)
{
    static const struct wrong cases[] = {
        { "render @cornell --light lamp:0,0,0:1,1,1", "lamp" },
        { "render @cornell --light point:0,0:1,1,1", "point:x,y,z:r,g,b" },
        { "render @cornell --light point:0,0,0:1,1,1:1", "point:x,y,z:r,g,b" },
        { "render @cornell --light point:0,0,0:1,-1,1", "negative" },
        { "render @cornell --light point:0,0,0:1,nan,1", "point:x,y,z:r,g,b" },
        { "render @cornell --light sun:0,0,0:1,1,1", "direction" },
        { "render @cornell --light sun:1,1,1", "sun:dx,dy,dz:r,g,b" },
        { "render @cornell --light spot:0,0,0:0,-1,0:30:20:1,1,1", "half-angles" },
        { "render @cornell --light spot:0,0,0:0,-1,0:20:91:1,1,1", "half-angles" },
        { "render @cornell --light spot:0,0,0:0,-1,0:a:20:1,1,1", "spot:" },
        { "render @cornell --light spot:0,0,0:0,-1,0:20:1,1,1", "spot:" },
        { "render @cornell --light area:0,0,0:0,-1,0:1,1", "area:" },
        { "render @cornell --light area:0,0,0:0,-1,0:1:1,1,1", "w,h" },
        { "render @cornell --light area:0,0,0:0,-1,0:1,0:1,1,1", "above 0" },
        { "render @cornell --light area:0,0,0:0,0,0:1,1:1,1,1", "direction" },
        { "render @cornell --light area:0,0,0:0,-1,0:1,1:1,1,-1", "negative" },
        { "render @cornell --light :", "sun:" },
        { "render @cornell --light sun:0,-1,0:1,1e38,1", "wrong value --light sun:0,-1,0" },
        { "render @cornell --light point:1e30,0,0:1,1,1", "wrong value --light point:1e30" },
        { "render @cornell --sky 1e38,0,0", "wrong value --sky: radiance" },
        { "render @cornell --eye 1e19,0,0 --target 0,0,0", "wrong value --eye, --target: eye" },
    };
    CHECK_WRONG(cases, 2);
}

TEST(wrong_layers_techniques_and_scenes_name_the_nearest)
{
    static const struct wrong cases[] = {
        { "render @cornell --aov color,irradianse", "irradiance" },
        { "render @cornell --aov color,color", "twice" },
        { "render @cornell --aov color,", "--aov" },
        { "render @cornell --aov debug", "--debug-view" },
        { "render @cornell --aov color,depth -o two.png", "two.png" },
        { "render @cornell --gi lpw", "lpv" },
        { "render @cornell --gi lpv:stepz=3", "steps" },
        { "render @cornell --gi lpv:steps=-1", "steps" },
        { "render @cornell --gi lpv+lpv", "lpv" },
        { "render @cornell --frame-options shadow_sise=512", "shadow_size" },
        { "render @cornell --debug-view no-such-view", "no-such-view" },
        { "render @cornel", "cornell" },
        { "render @cornell:lihgt=point", "light" },
        { "render @cornell:light=candle", "point" },
        { "info @nowhere", "nowhere" },
    };
    CHECK_WRONG(cases, 2);
}

TEST(wrong_output_names_are_wrong_usage)
{
    static const struct wrong cases[] = {
        { "render @cornell -o picture.jpg", "picture.jpg" },
        { "render @cornell -o picture", "picture" },
        { "render @cornell -o .png", ".png" },
        { "render @cornell -o %d-%d.png", "%d-%d.png" },
    };
    CHECK_WRONG(cases, 2);
}

TEST(unreadable_and_unwritable_files_fail)
{
    static const struct wrong cases[] = {
        { "render no/such/file.glb -o out.png", "no/such/file.glb" },
        { "info no/such/file.glb", "no/such/file.glb" },
        { "render @cornell -o no/such/folder/out.png", "no/such/folder" },
        { "render @cornell --stats no/such/folder/stats.json", "no/such/folder" },
        { "render @cornell -o /dev/null/out.png", "/dev/null" },
        { "render @cornell --camera nobody", "main" },
        { "render @cornell --animation walk", "walk" },
        { "diff no/such/a.exr no/such/b.exr", "no/such/a.exr" },
        { "diff no/such/a.png no/such/b.png", "no/such/a.png" },
        { "info /", "/" },
    };
    CHECK_WRONG(cases, 1);
}

TEST(a_folder_is_no_output)
{
    char folder[256], inside[300];
    snprintf(folder, sizeof folder, "%s", make_folder("folders"));
    snprintf(inside, sizeof inside, "%s/is-a-folder.png", folder);
    assert_int_equal(mkdir(inside, 0700), 0);
    check_one_error_line(run_expect(1, "render @cornell --size 8x8 -o", inside, NULL));
    assert_int_equal(count_files(folder), 1);
    assert_int_equal(count_files(inside), 0);
}

TEST(a_truncated_glb_fails_and_leaves_nothing)
{
    // A header that declares 1000 bytes, and the beginning of its JSON.
    static const char cut[] = "glTF\2\0\0\0\xe8\3\0\0\xd0\3\0\0JSON{\"asset\":{\"vers";
    char folder[256], scene[300], image[300];
    snprintf(folder, sizeof folder, "%s", make_folder("cut"));
    snprintf(scene, sizeof scene, "%s/cut.glb", folder);
    snprintf(image, sizeof image, "%s/out.png", folder);
    write_file(scene, cut, sizeof cut - 1);
    const struct run *r = run_expect(1, "render", scene, "-o", image, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "cut.glb"));
    check_one_error_line(run_expect(1, "info", scene, NULL));
    assert_int_equal(count_files(folder), 1);
}

TEST(a_line_break_in_a_name_does_not_break_the_line)
{
    check_one_error_line(run_expect(1, "info", "no\nsuch\nfile.glb", NULL));
    check_one_error_line(run_expect(2, "info @cornell", "--no\nsuch", NULL));
}

TEST(a_full_standard_output_is_a_failure)
{
    if (!file_exists("/dev/full")) test_skip("no /dev/full");
    char command[600];
    snprintf(command, sizeof command, "%s info @cornell >/dev/full 2>/dev/null", AFTERGLOW_PROGRAM);
    int status = system(command);
    assert_int_equal(WEXITSTATUS(status), 1);
}

enum { MAX_WORDS = 15, MAX_HELP_WORDS = 30 };

static int count_words(const char *text, size_t length)
{
    int words = 0;
    for (size_t i = 0; i < length; i++) words += text[i] != ' ' && (i == 0 || text[i - 1] == ' ');
    return words;
}

// Checks lines of text, and of help from `column` on in tables; command lines are exempt.
static void check_lines(const char *text, size_t column)
{
    for (size_t length; *text; text += length + (text[length] == '\n')) {
        length = strcspn(text, "\n");
        bool command = strncmp(text + strspn(text, " "), "afterglow ", 10) == 0;
        bool table = text[0] == ' ' && length > column;
        size_t name = strcspn(text, " \n"); // "lpv: light propagation volumes"
        size_t from = table ? column : name > 0 && text[name - 1] == ':' ? name : 0;
        if (!command && count_words(text + from, length - from) > MAX_WORDS)
            fail_msg("more than %d words: %.*s", MAX_WORDS, (int)length, text);
    }
}

TEST(a_line_of_help_has_at_most_15_words)
{
    static const char *const commands[] = { "",     "render", "reference", "compare",
                                            "info", "list",   "diff",      "cache" };
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++)
        check_lines(run_expect(0, commands[i], "--help", NULL)->out, 24);
    check_lines(run_expect(0, "list --quiet", NULL)->out, 34);
}

static void check_option_help(const json_t *owner)
{
    size_t i;
    json_t *option;
    json_array_foreach(json_object_get(owner, "options"), i, option)
    {
        const char *help = json_string_value(json_object_get(option, "help"));
        if (count_words(help, strlen(help)) > MAX_HELP_WORDS)
            fail_msg("more than %d words: %s", MAX_HELP_WORDS, help);
    }
}

TEST(the_help_of_an_option_fits_two_lines)
{
    json_t *list = run_json(run_expect(0, "list --json --quiet", NULL)), *owner;
    size_t i;
    json_array_foreach(json_object_get(list, "techniques"), i, owner) check_option_help(owner);
    json_array_foreach(json_object_get(list, "scenes"), i, owner) check_option_help(owner);
    json_decref(list);
}

// --report writes figures of an existing bake too; --report-full makes it again.
TEST(the_help_of_bake_explains_its_reports)
{
    const char *help = run_expect(0, "bake --help", NULL)->out;
    const char *report = strstr(help, "  --report FILE.json"),
               *full = strstr(help, "--report-full ");
    CHECK(strstr(help, "With --report, writes the seconds, memory and bytes"));
    CHECK(report && full && strstr(report, "bakes again even if a file exists") > full);
}

TEST(help_has_examples)
{
    static const char *const commands[] = { "render", "info", "list", "diff", "cache" };
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        const struct run *r = run_expect(0, commands[i], "--help", NULL);
        CHECK_STRING(r->err, "");
        CHECK(strstr(r->out, "Examples:\n"));
        char example[64];
        snprintf(example, sizeof example, "  afterglow %s", commands[i]);
        CHECK(strstr(strstr(r->out, "Examples:"), example));
        CHECK(strstr(run_expect(0, "--help", NULL)->out, commands[i]));
    }
    CHECK(strncmp(run_expect(0, "--version", NULL)->out, "afterglow 0.", 12) == 0);
    CHECK(strncmp(run_expect(0, "-V", NULL)->out, "afterglow 0.", 12) == 0);
}
