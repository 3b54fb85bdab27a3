// Files and images that scripts of the viewer save, and the command of a view.
#pragma once

#include "cli/view/window.h"

#include "image/png_file.h"

#define CORNELL "view @cornell:light=point --quiet"
#define SMALL   " --size 640x480 --scale 0.25"
#define LEAST   " --size 400x240 --scale 0.2"

// Two files have different bytes; an image has a size.
void check_differ(const char *a, const char *b);
void check_size(const char *path, int width, int height);
// The mean of all channels of a PNG, linear.
double mean_of(const char *path);

// Runs the command of a file as a shell does, for the program under test, to an image.
void run_line(const char *path, const char *output);
// The command of the view at the end of a script renders the bytes of its image.
void check_command(const char *words, const char *script);
