// Shared by C and the shaders of ssr. Scalar layout.
#ifndef AG_SSR_SHARED_H
#define AG_SSR_SHARED_H

#include "core/shared.h"

#define SSR_LEVELS 6 // of the depth pyramid; the first one has the frame's pixels
#define SSR_MIPS   6 // of the radiance, at most

// Specialization constants.
#define SSR_CONSTANT_STEP  0 // pixels of the frame per traced pixel, along x and y
#define SSR_CONSTANT_REUSE 1 // side of the square of traced pixels whose rays a pixel reuses

// Uniform block "ssr".
struct ssr_params {
    uint32_t width, height;           // of the frame, pixels
    uint32_t work_width, work_height; // traced pixels
    uint32_t steps;                   // cells that a ray visits at most
    uint32_t first_sample;            // of the frame, in the sequence of directions
    uint32_t has_dielectric;          // bool, as has_history
    uint32_t has_history;
    float has_visibility; // 1, or 0: no technique of the stack writes visibility
    float thickness_m;
    float max_roughness;
    float border_px;        // over which reflections fade
    float pixel_m;          // width of a pixel at 1 m, or at any distance in orthographic views
    float focal_px;         // 1 / pixel_m
    float mip_scale;        // width of a mip's texel over that of a ray's part of the lobe
    float spread_roughness; // from which on rays are spread over the whole lobe
};

// Push constants of the debug views.
struct ssr_view_push {
    uint32_t distance; // bool: hit distances; confidence else
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct ssr_params) == 16 * 4, "layout is shared with GLSL");
#endif

#endif
