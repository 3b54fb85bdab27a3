// Scripts of the viewer under a virtual display, with the validation layers, whose messages fail
// the program.
#pragma once

#include "cli/program.h"

#include "image/png_file.h"

#define CORNELL "view @cornell:light=point --quiet"
#define SMALL   " --size 640x480 --scale 0.25"
#define LEAST   " --size 400x240 --scale 0.2"

// The folder of the test has the files of scripts, of the program, and its cache.
void enter_folder(void);
// Enters it and starts the display; skips the test where there is none.
void require_display(void);

// Runs view with a script, which must succeed without a message.
void view(const char *words, const char *script);
// The script must fail with one line that has a text.
void check_fails(const char *words, const char *script, const char *names);
// Files have the same bytes; an image has a size.
void check_equal(const char *a, const char *b);
void check_differ(const char *a, const char *b);
void check_size(const char *path, int width, int height);
// The mean of all channels of a PNG, linear.
double mean_of(const char *path);

// Runs the command of a file as a shell does, for the program under test, to an image.
void run_line(const char *path, const char *output);
// The command of the view at the end of a script renders the bytes of its image.
void check_command(const char *words, const char *script);
