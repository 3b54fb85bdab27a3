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
    vec4s distance_of_depth;          // see struct frame_constants
    vec4s previous_depth_of_distance; // depth = (x + y · distance) / (z + w · distance)
    // x + y · D: pixels per metre across the view axis at the depth D. z + w / D: pixels of δ
    // (screen_ao.glsl) per difference of D.
    vec4s scale, previous_scale;
    vec3s right, down, forward; // image axes in world space, unit
    float focal_px;    // pixels per unit of the angle's tangent, or per metre in orthographic views
    float perspective; // 1; 0: orthographic
    float radius_m;    // of the sphere
    float max_radius_px;                // largest radius of the sphere on the screen
    float rotation;                     // of the frame's pattern, 0…1 is a full turn
    float center_x, center_y;           // pixel on the view axis
    uint32_t width, height;             // of the frame, pixels
    uint32_t work_width, work_height;   // of the estimate, pixels
    uint32_t has_history;               // bool
    float jitter_step_x, jitter_step_y; // see struct frame_constants
    uint32_t padding;                   // vec4s is aligned to 16 bytes in C
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct screen_ao_params) == 40 * 4, "layout is shared with GLSL");
#endif

#endif
