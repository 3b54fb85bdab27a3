// What the shaders of volumetric obscurance share with the host. Scalar layout.
#ifndef AG_VO_SHARED_H
#define AG_VO_SHARED_H

#include "core/shared.h"

#define VO_MOST_SAMPLES 33

// Uniform block "vo_table".
struct vo_samples {
    // Lines: x, y in the disk, half length, weight over length, opposite ones next to each other.
    // Points: x, y, z in the ball, weight. Areas: as lines.
    vec4s at[VO_MOST_SAMPLES];
    float levels[VO_MOST_SAMPLES]; // areas: of the pyramid, log2 of the side in radii
    int32_t level_count;           // of the pyramid, those in use
    vec2s radii_m;                 // the second 0: there is but the first
    float thickness;               // of occluders, radii
    float centre; // weight of the sample at the sphere's centre, which needs no look; 0: there is
                  // none
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vo_samples) == VO_MOST_SAMPLES * 20 + 20,
               "layout is shared with GLSL");
#endif

#endif
