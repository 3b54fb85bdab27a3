// Tone curve and metering of displayed images: frame options of all renderings.
#pragma once

#include "viewer/state.h"

extern const char *const viewer_curves[3];    // names, by enum ag_tonemap
extern const char *const viewer_meterings[2]; // likewise, by enum ag_metering

// The curve or the metering of a name; -1: none.
int viewer_curve_of(const char *name);
int viewer_metering_of(const char *name);
// Shows images by another curve; false, with a message, if it cannot.
bool viewer_set_tonemap(struct viewer *v, enum ag_tonemap curve);
// Likewise, by another rule of automatic exposure.
bool viewer_set_metering(struct viewer *v, enum ag_metering metering);
// Frame options of all renderings; NULL: the defaults.
const char *viewer_frame_options(const struct viewer *v);
