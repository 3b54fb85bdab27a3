// Shared by C and the shaders of volumetric obscurance. Scalar layout.
#ifndef AG_VO_SHARED_H
#define AG_VO_SHARED_H

#include "core/shared.h"
#include "techniques/common/screen_ao_shared.h"

#define VO_MOST_SAMPLES 33

// Specialization constants of the estimate.
#define VO_CONSTANT_COUNT     SCREEN_AO_CONSTANT_NEXT // samples
#define VO_CONSTANT_NORMAL    (SCREEN_AO_CONSTANT_NEXT + 1)
#define VO_CONSTANT_TWO_RADII (SCREEN_AO_CONSTANT_NEXT + 2)

// Uniform block "vo_table".
struct vo_samples {
    // Lines and areas: x, y in the disk, half length, weight over length; opposite samples are
    // adjacent. Points: x, y, z in the ball, weight.
    vec4s at[VO_MOST_SAMPLES];
    float levels[VO_MOST_SAMPLES]; // areas: pyramid level, log2 of the side in radii
    int32_t level_count;           // pyramid levels in use
    vec2s radii_m;                 // the second is 0 without a second sphere
    float thickness;               // of occluders, radii
    float center; // weight of the sample at the sphere's center, known without a fetch; 0: none
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vo_samples) == VO_MOST_SAMPLES * 20 + 20,
               "layout is shared with GLSL");
#endif

#endif
