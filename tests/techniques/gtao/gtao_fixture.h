// Visibility of gtao in a full frame, without the blur.
#pragma once

#include "frame/frame_fixture.h"

// One frame of the open scene with these options, "slices=8,radius=1"; 1 float a pixel, to be
// freed.
float *gtao_visibility(struct frame_fixture *s, const char *options);
// Unoccluded share of the cosine-weighted hemisphere around +z by a grid of directions; open:
// whether the direction (x, y, z) is unoccluded.
double gtao_share(bool (*open)(vec3s direction, const void *user), const void *user);
