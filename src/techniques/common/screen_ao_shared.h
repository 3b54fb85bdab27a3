// What the shaders of the techniques that look for occluders in the depth buffer share with the
// host. Scalar layout.
#ifndef AG_SCREEN_AO_SHARED_H
#define AG_SCREEN_AO_SHARED_H

#include "core/shared.h"

#define SCREEN_AO_ROWS 8 // pixels of the estimate below each other that one invocation does

// Specialization constants of the passes; those of a technique's estimate follow.
#define SCREEN_AO_CONSTANT_STEP 0 // pixels of the frame per pixel of the estimate, along x and y
#define SCREEN_AO_CONSTANT_NEXT 1

// Uniform block "screen_ao".
struct screen_ao_params {
    vec3s right, down, forward; // of the picture, world space, unit
    float focal_px;             // pixels per unit of the angle's tangent
    float near_m;
    float radius_m;                   // of the sphere in which occluders count
    float most_px;                    // the sphere's radius on the screen at most
    float turn;                       // of the pattern in this frame, 0…1
    float middle_x, middle_y;         // of the picture, pixels
    uint32_t width, height;           // of the frame, pixels
    uint32_t work_width, work_height; // of the estimate, pixels
    float before_near_m;              // of the last frame's camera; 0: no frame to go on from
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct screen_ao_params) == 21 * 4, "layout is shared with GLSL");
#endif

#endif
