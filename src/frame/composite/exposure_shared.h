// Automatic exposure on the GPU: two rounds of sums, each in groups first and then over the groups.
#ifndef AG_FRAME_EXPOSURE_SHARED_H
#define AG_FRAME_EXPOSURE_SHARED_H

#include "core/shared.h"

#define EXPOSURE_THREADS    64 // of a group
#define EXPOSURE_PIXELS     16 // that a thread adds up, until there are EXPOSURE_MAX_GROUPS
#define EXPOSURE_MAX_GROUPS 1024

// What storage block "exposure_state" holds.
struct exposure_values {
    float ev;
    float floor_log2; // log2 of the least luminance that a pixel counts as, scaled radiance
    uint32_t lit;     // whether any pixel is lit
};

struct exposure_push {
    uint32_t round_index; // 0: over lit pixels; 1: over all, with the floor
    uint32_t groups;
    vec3s emitted;  // scaled lux: mean irradiance by emissive surfaces
    float fallback; // scaled luminance that is metered where no surface in sight is lit
};

#endif
