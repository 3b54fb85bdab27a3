#include "help.h"
#include "commands.h"
#include "cli/options/option_table.h"
#include "cli/terminal/wrapped.h"

#include <stdio.h>

enum { HELP_COLUMN = 24 };

void help_program(void)
{
    printf("Afterglow: real-time global illumination, measured against a path-traced reference\n\n"
           "Usage: afterglow COMMAND ARGUMENTS [options]\n\n"
           "Commands:\n");
    const struct command *command;
    for (int i = 0; (command = command_get(i)); i++)
        printf("  %-11s%s\n", command->name, command->summary);
    printf("\nSCENE is a file (.gltf, .glb, .obj, .ply, .fbx, .x) or a built-in scene (@cornell).\n"
           "\nFirst steps:\n"
           "  afterglow render @cornell --gi lpv -o cornell.png\n"
           "  afterglow compare @cornell --size 320x180\n"
           "  afterglow list\n"
           "  afterglow list lpv\n"
           "  afterglow help render\n"
           "\nExit status: 0 success, 1 failure, 2 wrong usage.\n");
}

static void print_option(const struct command_option *option)
{
    int wrote = printf("  %s%s%s", option->name, option->value ? " " : "",
                       option->value ? option->value : "");
    if (wrote >= HELP_COLUMN) wrote = printf("\n") - 1;
    printf("%*s", HELP_COLUMN - wrote, "");
    print_wrapped(HELP_COLUMN, option->help);
}

static void print_options(const struct command *command)
{
    const char *heading = NULL;
    struct command_option option;
    for (int i = 0; command_option_get(command, i, &option); i++) {
        if (option.heading != heading) printf("\n%s:\n", option.heading);
        heading = option.heading;
        print_option(&option);
    }
}

void help_command(const struct command *command)
{
    printf("Usage: afterglow %s%s%s\n\n%s\nExamples:\n%s", command->name,
           command->usage[0] ? " " : "", command->usage, command->text, command->examples);
    print_options(command);
}
