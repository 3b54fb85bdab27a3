// One command, one file.
#pragma once

#include "arguments.h"

enum { MAX_COMMANDS = 16 };

extern const struct command command_render, command_reference, command_compare, command_info,
    command_list, command_diff, command_bake, command_cache, command_view;

// The commands in the order of --help; NULL past the end.
const struct command *command_get(int index);
// NULL: none of that name.
const struct command *command_find(const char *name);
