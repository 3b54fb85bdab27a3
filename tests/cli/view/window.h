// The program with a window: a virtual display, and scripts of view, with the validation layers,
// whose messages fail the program.
#pragma once

#include "cli/program.h"

#define WINDOW_SCRIPT "script.txt"

// The folder of the test has the files of scripts, of the program, and its cache.
void enter_folder(void);
// A display of 96 dots an inch. Skips the test, visibly, without one or without a device.
void require_display(void);
// Likewise, another one of that density. It is the display of the test until its end.
void require_display_of(int dots_per_inch);

// Runs the script in silence.
void view(const char *words, const char *script);
// Runs the script, which must fail with one line that has the text.
void check_fails(const char *words, const char *script, const char *names);
void check_equal(const char *a, const char *b);
