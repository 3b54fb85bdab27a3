// Shared by C and the shaders of hbao. Scalar layout.
#ifndef AG_HBAO_SHARED_H
#define AG_HBAO_SHARED_H

#include "core/shared.h"

// Uniform block "hbao_table".
struct hbao_params {
    int32_t directions, steps;
    float bias;        // tangent of the angle between the tangent plane and the first horizon
    int32_t quadratic; // falloff 1 − r², else 1 − r³
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct hbao_params) == 4 * 4, "layout is shared with GLSL");
#endif

#endif
