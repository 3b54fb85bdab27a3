// Other scenes and sessions in the window.
#pragma once

#include "viewer/state.h"

// Opens the scene or the session of a file, a scene after a frame that says so. False, with a
// message: a session of this scene is wrong.
bool viewer_open(struct viewer *v, const char *path);
