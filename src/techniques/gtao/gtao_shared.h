// Shared by C and the shaders of gtao. Scalar layout.
#ifndef AG_GTAO_SHARED_H
#define AG_GTAO_SHARED_H

#include "core/shared.h"

// Specialization constants after that of screen_ao: bitmasks instead of horizons; occluders fade.
#define GTAO_CONSTANT_BITMASK 1
#define GTAO_CONSTANT_FALLOFF 2

// Uniform block "gtao_table".
struct gtao_params {
    int32_t slices, steps;
    float falloff;     // radii
    float thickness_m; // of occluders, along the line of sight
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct gtao_params) == 4 * 4, "layout is shared with GLSL");
#endif

#endif
