// The manual page: what --help and `afterglow list` print, for man.
#include "manual_page.h"

#include "cli/commands.h"
#include "cli/options/option_table.h"
#include "cli/options/option_text.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <string.h>

// The escape of a character in roff; NULL: the character itself. A line may end after \:.
static const char *escape_of(char c)
{
    static const char characters[] = "\\-'`^~|,";
    static const char *const escapes[] = { "\\e",   "\\-",   "\\(aq", "\\(ga",
                                           "\\(ha", "\\(ti", "|\\:",  ",\\:" };
    const char *at = strchr(characters, c);
    return at ? escapes[at - characters] : NULL;
}

// Escaped text; a '\n' becomes `line_end`, which ends in a newline. At the start of a line, '.' and
// '\'' would be requests.
static void print_text(const char *text, const char *line_end)
{
    bool start = true;
    for (; *text; text++) {
        const char *escape = *text == '\n' ? line_end : escape_of(*text);
        if (start && (*text == '.' || *text == '\'')) printf("\\&");
        start = *text == '\n';
        if (escape)
            printf("%s", escape);
        else
            putchar(*text);
    }
}

static void print_line(const char *text)
{
    print_text(text, "\n.br\n");
    printf("\n");
}

// A literal block: examples.
static void print_block(const char *text)
{
    printf(".PP\n.nf\n");
    print_text(text, "\n");
    printf(".fi\n");
}

// ".TP", a bold name and an italic value.
static void print_tag(const char *name, const char *separator, const char *value)
{
    printf(".TP\n\\fB");
    print_text(name, "\n");
    printf("\\fR%s\\fI", separator);
    print_text(value, "\n");
    printf("\\fR\n");
}

static void print_command_line(const struct command *command)
{
    printf("\\fBafterglow %s\\fR", command->name);
    if (command->usage[0]) printf(" ");
    print_line(command->usage);
}

static void print_synopsis(void)
{
    const struct command *command;
    printf(".SH SYNOPSIS\n");
    for (int i = 0; (command = command_get(i)); i++) {
        if (i > 0) printf(".br\n");
        print_command_line(command);
    }
    printf(".br\n\\fBafterglow \\-\\-version\\fR\n");
}

static void print_command(const struct command *command)
{
    const char *heading = NULL;
    struct command_option option;
    printf(".SS afterglow %s\n", command->name);
    print_text(command->text, "\n");
    for (int i = 0; command_option_get(command, i, &option); i++) {
        if (option.heading != heading) printf(".PP\n%s:\n", option.heading);
        heading = option.heading;
        print_tag(option.name, option.value ? " " : "", option.value ? option.value : "");
        print_line(option.help);
    }
    printf(".PP\nExamples:\n");
    print_block(command->examples);
}

static void print_option_info(const struct ag_option_info *option)
{
    char value[64], range[512];
    option_range(option, range);
    print_tag(option->name, "=", option_default(option, value));
    print_text(option->help, "\n.br\n");
    print_line(range);
}

static void print_technique(int index, const struct ag_technique_info *technique)
{
    const char *name, *text;
    struct ag_option_info option;
    printf(".SS %s\n", technique->name);
    print_line(technique->title);
    printf(".PP\n");
    print_line(technique->paper);
    for (int i = 0; ag_technique_option_get(index, i, &option); i++) print_option_info(&option);
    for (int i = 0; ag_technique_preset_get(index, i, &name, &text); i++) {
        print_tag("quality", "=", name);
        print_line(text[0] ? text : "the defaults");
    }
    for (int i = 0; ag_technique_debug_view_get(index, i, &name, &text); i++) {
        print_tag("--debug-view", " ", name);
        print_line(text);
    }
}

static void print_catalogue(void)
{
    struct ag_technique_info technique;
    struct ag_builtin_scene_info scene;
    struct ag_option_info option;
    printf(".SH TECHNIQUES\nNames and options of \\fB\\-\\-gi\\fR, with defaults and ranges.\n");
    for (int i = 0; ag_technique_get(i, &technique); i++) print_technique(i, &technique);
    printf(".SH FRAME OPTIONS\nOptions of \\fB\\-\\-frame\\-options\\fR.\n");
    for (int i = 0; ag_frame_option_get(i, &option); i++) print_option_info(&option);
    printf(".SH BUILT-IN SCENES\nSCENE is a file (.gltf, .glb, .obj, .ply, .fbx, .x) or "
           "\\fB@NAME\\fR[:OPTION=VALUE,...].\n");
    for (int i = 0; ag_builtin_scene_get(i, &scene); i++) {
        printf(".SS @%s\n", scene.name);
        print_line(scene.title);
        for (int k = 0; ag_builtin_scene_option_get(i, k, &option); k++) print_option_info(&option);
    }
}

static void print_environment(void)
{
    static const char *const variables[][2] = {
        { "AFTERGLOW_CACHE", "folder of cached references and bakes\n(default: afterglow in "
                             "XDG_CACHE_HOME or ~/.cache)" },
        { "AFTERGLOW_IMPORTER", "program that reads OBJ, FBX and X files (default: the installed "
                                "afterglow-import)" },
        { "AFTERGLOW_SHADER_DIR", "folder of .spv files that replace the embedded shaders" },
        { "AFTERGLOW_VALIDATION", "1: enable Vulkan's validation layers; their messages are "
                                  "failures" },
    };
    printf(".SH ENVIRONMENT\n");
    for (int i = 0; i < (int)(sizeof variables / sizeof variables[0]); i++) {
        print_tag(variables[i][0], "", "");
        print_line(variables[i][1]);
    }
}

void print_manual_page(void)
{
    const int version = ag_version();
    const struct command *command;
    printf(".TH AFTERGLOW 1 \"\" \"afterglow %d.%d.%d\" \"User Commands\"\n.nh\n.ad l\n",
           version / 10000, version / 100 % 100, version % 100);
    printf(".SH NAME\nafterglow \\- real-time global illumination, measured against a path-traced "
           "reference\n");
    print_synopsis();
    printf(".SH COMMANDS\n");
    for (int i = 0; (command = command_get(i)); i++) print_command(command);
    print_catalogue();
    print_environment();
    printf(".SH EXIT STATUS\n0: success, 1: failure, 2: wrong usage.\n");
}
