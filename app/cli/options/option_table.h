// The options of all commands, as options.def lists them.
#pragma once

#include "cli/arguments.h"

enum { MAX_OPTIONS = 128 };

// Stores a value; false with *why, a static text that names the valid values, for a wrong one.
typedef bool option_setter(struct arguments *a, const char *value, const char **why);

struct command_option {
    const char *name, *value; // value NULL: a switch
    const char *heading;      // of its group
    const char *help;         // '\n' begins a line
    option_setter *set;
};

// Option `index` of a command, in the order of --help; false past the end.
bool command_option_get(const struct command *command, int index, struct command_option *out);
// The option whose name is the first `length` characters; false: none.
bool command_option_find(const struct command *command, const char *name, size_t length,
                         struct command_option *out);
