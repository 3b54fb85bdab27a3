#pragma once

#include <stdint.h>

#include "frame/frame.h"

// Of the lights, the sky and the filter of shadows, in the units of the frame: equal in frames
// whose direct light on still geometry is equal.
uint64_t light_hash(const struct frame_view *view);
