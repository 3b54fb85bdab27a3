// How a caller's G-buffer encodes what the frame's own has, C and GLSL. Scalar layout.
#ifndef AG_FRAME_GBUFFER_ENCODING_H
#define AG_FRAME_GBUFFER_ENCODING_H

#include "core/shared.h"

#define GBUFFER_NO_CHANNEL 4 // in place of a channel: roughness 1, metallic 0

// Uniform block "gbuffer_encoding". FRAME_DEPTH = depth_offset + depth_scale · the caller's depth,
// both of which are linear in 1 / distance (perspective) or distance (orthographic).
struct gbuffer_encoding {
    float depth_offset, depth_scale, depth_without_surface;
    float normal_scale, normal_bias;      // normal = scale · sampled value + bias, by component
    uint32_t normal_octahedral;           // bool: two components (frame/octahedral.glsl), not three
    uint32_t normal_in_view_space;        // bool
    uint32_t albedo_alpha;                // bool: the alpha is that of FRAME_ALBEDO, not any
    uint32_t roughness, metallic;         // channels, or GBUFFER_NO_CHANNEL
    float motion_scale_x, motion_scale_y; // motion = scale · sampled value + offset
    float motion_offset_x, motion_offset_y;
    uint32_t motion_has_distance; // bool: z is that of FRAME_MOTION; else surfaces do not move
    uint32_t has_material, has_emissive; // bools: the image is bound
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct gbuffer_encoding) == 17 * 4, "layout is shared with GLSL");
#endif

#endif
