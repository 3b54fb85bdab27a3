// What reading a shadow map needs. Scalar layout.
#ifndef AG_FRAME_SHADOW_SHARED_H
#define AG_FRAME_SHADOW_SHARED_H

#include "core/shared.h"

// Storage block "shadow_faces": one per layer of the shadow map array; frame_light.shadow_first
// points here.
struct shadow_face {
    mat4s clip_from_world;
    float texel_m;     // suns: edge of a texel; else: its edge at distance 1
    float depth_scale; // compare depth · depth_scale + depth_offset: moves the receiver towards the
                       // light
    float depth_offset;
    uint32_t padding;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct shadow_face) == 80, "layout is shared with GLSL");
#endif

#endif
