// Other scenes and sessions in the window.
#pragma once

#include "viewer/state.h"

// Opens the scene or the session of a file, after a frame that says so.
void viewer_open(struct viewer *v, const char *path);
