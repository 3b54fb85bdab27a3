// A view taken away: as a command line, as an image.
#pragma once

#include "state.h"

// The command that renders this view; false: a change of the scene cannot be said in options.
bool viewer_command(struct viewer *v, char *out, size_t size);
// Writes the image as afterglow render does: .png or .exr.
bool viewer_write(struct viewer *v, const char *path);
