// The tone curve of displayed images: a frame option of all renderings.
#pragma once

#include "viewer/state.h"

extern const char *const viewer_curves[3]; // names, by enum ag_tonemap

// The curve of a name; -1: none.
int viewer_curve_of(const char *name);
// Shows images by another curve; false, with a message, if it cannot.
bool viewer_set_tonemap(struct viewer *v, enum ag_tonemap curve);
// Frame options of all renderings; NULL: the defaults.
const char *viewer_frame_options(const struct viewer *v);
