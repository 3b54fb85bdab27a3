// Shared by C and the shaders of ssao. Scalar layout.
#ifndef AG_SSAO_SHARED_H
#define AG_SSAO_SHARED_H

#include "core/shared.h"
#include "techniques/common/screen_ao_shared.h"

#define SSAO_MOST_SAMPLES 33

// Specialization constants of the estimate.
#define SSAO_CONSTANT_COUNT  SCREEN_AO_CONSTANT_NEXT // samples
#define SSAO_CONSTANT_NORMAL (SCREEN_AO_CONSTANT_NEXT + 1)

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
