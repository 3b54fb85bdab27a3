// A slow version of gtao over the G-buffer, from the definition: angles, and integrals over them by
// sums.
#pragma once

#include "frame/frame_fixture.h"

struct gtao_twin {
    int slices, steps;
    float radius_m, reach, falloff;
    bool bitmask;
    float thickness_m;
    const float *position, *normal, *depth; // of the frame
};

double gtao_twin_visibility(const struct gtao_twin *twin, const struct frame_fixture *s, int x,
                            int y);
