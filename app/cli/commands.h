// One command, one file.
#pragma once

#include "arguments.h"

extern const struct command command_render, command_reference, command_compare, command_info,
    command_list, command_diff, command_bake, command_cache;
