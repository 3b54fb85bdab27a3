// What the shaders of the ambient technique share with the host. Scalar layout.
#ifndef AG_AMBIENT_SHARED_H
#define AG_AMBIENT_SHARED_H

#include "core/shared.h"

#define AMBIENT_LOCAL 64  // invocations of a summing workgroup
#define AMBIENT_GROUPS 64 // summing workgroups, and partial sums
#define AMBIENT_TEXELS 4  // side of a block of texels

// Push constants of all passes.
struct ambient_push {
    vec3s sky;              // scaled irradiance of the sky
    float per_area;         // 1/m²: irradiance per reflected flux; 0 where the bounds have no surface
    float strength;
    uint32_t rsm_size;      // texels
    uint32_t blocks_across; // blocks in a row of a reflective shadow map
    uint32_t blocks;        // in all reflective shadow maps
    uint32_t width, height; // of the frame, pixels
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct ambient_push) == 10 * 4, "layout is shared with GLSL");
#endif

#endif
