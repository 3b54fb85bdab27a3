// Shadow map faces, C and GLSL. Scalar layout.
#ifndef AG_FRAME_SHADOW_SHARED_H
#define AG_FRAME_SHADOW_SHARED_H

#include "core/shared.h"

// Storage block "shadow_faces": one per layer of the shadow map array; frame_light.shadow_first
// points here.
struct shadow_face {
    mat4s clip_from_world;
    float texel_m; // edge of a texel; points and spots: at distance 1
    // Depth bias: the receiver's depth is depth · depth_scale + depth_offset.
    float depth_scale, depth_offset;
    uint32_t padding;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct shadow_face) == 80, "layout is shared with GLSL");
#endif

#endif
