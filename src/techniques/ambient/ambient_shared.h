// Shared by C and the shaders of the ambient technique. Scalar layout.
#ifndef AG_AMBIENT_SHARED_H
#define AG_AMBIENT_SHARED_H

#include "core/shared.h"

#define AMBIENT_LOCAL  64 // invocations of a reduction workgroup
#define AMBIENT_GROUPS 64 // reduction workgroups, and partial sums
#define AMBIENT_TEXELS 4  // side of a block of texels

// Push constants of all passes.
struct ambient_push {
    vec3s uniform_irradiance; // scaled: of emissive surfaces
    float per_path; // 1/m³: irradiance per flux and path length; 0 if the bounds have no volume
    vec3s box_min, box_max; // bounds of the scene
    float strength;
    uint32_t rsm_size;       // texels
    uint32_t blocks_across;  // blocks in a row of a reflective shadow map
    uint32_t blocks;         // in all reflective shadow maps
    uint32_t width, height;  // of the frame, pixels
    uint32_t has_dielectric; // bool: there is FRAME_DIELECTRIC
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct ambient_push) == 17 * 4, "layout is shared with GLSL");
#endif

#endif
