// Shadow map faces, C and GLSL. Scalar layout.
#ifndef AG_FRAME_SHADOW_SHARED_H
#define AG_FRAME_SHADOW_SHARED_H

#include "core/shared.h"

// Storage block "shadow_faces": one per face; frame_light.shadow_first points here.
struct shadow_face {
    mat4s clip_from_world;
    float texel_m; // longer edge of a texel; points and spots: at distance 1
    // Depth bias of filtered lookups: the receiver's depth is depth · depth_scale + depth_offset.
    float depth_scale, depth_offset;
    // A difference of NDC depth times clip w times this is a distance in texels.
    float depth_texels;
    float size;    // texels along an edge of the map
    int32_t layer; // of shadow_sun_maps for suns, of shadow_maps for other lights
    uint32_t padding[2];
};

// Edge of a block of a sun's shadow map in texels: shadow_blocks.comp.
#define SHADOW_BLOCK 8

// Push constants of shadow_blocks.comp.
struct shadow_blocks_push {
    int32_t layer;
    float depth_texels; // of the face
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct shadow_face) == 96, "layout is shared with GLSL");
#endif

#endif
