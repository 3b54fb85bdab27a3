// What the shader of ssao shares with the host. Scalar layout.
#ifndef AG_SSAO_SHARED_H
#define AG_SSAO_SHARED_H

#include "core/shared.h"

#define SSAO_MOST_SAMPLES 33

// Uniform block "ssao_table".
struct ssao_samples {
    vec4s at[SSAO_MOST_SAMPLES]; // x, y, z in the ball, weight
    float range;                 // radii
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct ssao_samples) == SSAO_MOST_SAMPLES * 16 + 4,
               "layout is shared with GLSL");
#endif

#endif
