// Shared by C and the shaders of screen-space occlusion. Scalar layout.
#ifndef AG_SCREEN_AO_SHARED_H
#define AG_SCREEN_AO_SHARED_H

#include "core/shared.h"

#define SCREEN_AO_ROWS 8 // pixels of a column per invocation of the estimate

// Specialization constants of the passes; those of a technique's estimate follow.
#define SCREEN_AO_CONSTANT_STEP 0 // pixels of the frame per pixel of the estimate, along x and y
#define SCREEN_AO_CONSTANT_NEXT 1

// Uniform block "screen_ao".
struct screen_ao_params {
    vec3s right, down, forward; // image axes in world space, unit
    float focal_px;             // pixels per unit of the angle's tangent
    float near_m;
    float radius_m;                   // of the sphere
    float max_radius_px;              // largest radius of the sphere on the screen
    float rotation;                   // of the frame's pattern, 0…1 is a full turn
    float center_x, center_y;         // of the image, pixels
    uint32_t width, height;           // of the frame, pixels
    uint32_t work_width, work_height; // of the estimate, pixels
    float previous_near_m;            // of the previous camera; 0: no valid history
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct screen_ao_params) == 21 * 4, "layout is shared with GLSL");
#endif

#endif
