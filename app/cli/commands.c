// The commands in the order of --help.
#include "commands.h"

#include <afterglow/catalogue.h>

#include <stddef.h>
#include <string.h>

static const struct command *const commands[] = {
    &command_render, &command_view, &command_reference, &command_compare, &command_bake,
    &command_info,   &command_list, &command_diff,      &command_cache
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };
_Static_assert(sizeof commands / sizeof commands[0] <= (size_t)MAX_COMMANDS, "main lists fewer");

// There is nothing to bake where no technique needs it.
static bool is_offered(const struct command *command)
{
    struct ag_technique_info info;
    if (command->bit != BAKE) return true;
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (info.needs_bake) return true;
    return false;
}

const struct command *command_get(int index)
{
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (is_offered(commands[i]) && index-- == 0) return commands[i];
    return NULL;
}

const struct command *command_find(const char *name)
{
    const struct command *command;
    for (int i = 0; (command = command_get(i)); i++)
        if (strcmp(command->name, name) == 0) return command;
    return NULL;
}
