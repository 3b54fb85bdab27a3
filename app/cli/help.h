// The texts of --help, on standard output.
#pragma once

#include "arguments.h"

// Prints how to run the program, and its commands.
void help_program(void);
// Prints the usage of one command, and its options.
void help_command(const struct command *command);
