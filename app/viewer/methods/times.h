// Milliseconds of the newest frames.
#pragma once

#include "viewer/state.h"

// Adds the newest frame that the GPU has finished, if it is another one.
void times_add(struct viewer *v);
