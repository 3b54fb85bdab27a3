// What the completions of both shells list.
#pragma once

#include "cli/commands.h"

#include <stdio.h>

// Values of an option that are known: a list of words separated by spaces in `out`; "" for others.
void completion_words(const struct command_option *option, char *out, size_t size);
// Whether an option's value is a path.
bool completion_is_path(const struct command_option *option);
// All built-in scenes, "@cornell @atrium …".
void completion_scenes(char *out, size_t size);
