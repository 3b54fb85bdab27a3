// Automatic exposure on the GPU: two passes, each of which sums per work group and then over
// groups.
#ifndef AG_FRAME_EXPOSURE_SHARED_H
#define AG_FRAME_EXPOSURE_SHARED_H

#include "core/shared.h"

#define EXPOSURE_THREADS    64 // per work group
#define EXPOSURE_PIXELS     16 // per thread, until EXPOSURE_MAX_GROUPS is reached
#define EXPOSURE_MAX_GROUPS 1024

#define EXPOSURE_CONSTANT_SECOND_PASS 0 // specialization constant of exposure_sum.comp

// Content of the storage block "exposure_state".
struct exposure_values {
    float ev;
    float floor_log2; // log2 of the smallest luminance that is metered, in scaled radiance
    uint32_t lit;     // 1: at least one pixel is lit
};

struct exposure_push {
    uint32_t pass_index; // 0: lit pixels; 1: all surface pixels, clamped to the floor
    uint32_t groups;
    vec3s emitted;  // scaled lux: mean irradiance from emissive surfaces
    float fallback; // scaled luminance that is metered if no visible surface is lit
};

#endif
