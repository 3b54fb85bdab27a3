// The methods that run: that of the whole image, another one in the right part of a split screen,
// and the reference.
#pragma once

#include "viewer/state.h"

// Opens the first rendering; on a software device with the preset "low" where `gi` has no options.
bool running_begin(struct viewer *v, const char *gi);
// Runs another method from the next frame on, or when its bake is there; false, with a message, if
// it cannot.
bool viewer_set_gi(struct viewer *v, const char *gi);
// The same where `gi` runs already, and files that its options name have changed.
bool viewer_begin_gi_again(struct viewer *v, const char *gi);
bool viewer_set_split(struct viewer *v, const char *gi); // NULL: ends the split screen
bool viewer_set_reference(struct viewer *v, bool on);    // the reference in the right part
// After a frame: gives the reference its view and takes its image.
void running_step(struct viewer *v);
void running_end(struct viewer *v);
