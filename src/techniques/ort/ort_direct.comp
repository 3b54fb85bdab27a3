// First-order irradiance of each texel, at its place.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define SHADOW_FACES_BINDING      2
#define SHADOW_MAPS_BINDING       3
#define SHADOW_SUN_MAPS_BINDING   12
#define LIGHT_MAP_TEXELS_BINDING  4
#define LIGHT_MAP_LIGHTS_BINDING  5
#define LIGHT_MAP_PAINT_BINDING   8
#define LIGHT_MAP_SKY_BINDING     9
#define LIGHT_MAP_PATCHES_BINDING 10
#define FRAME_CONSTANTS_COPIED
#include "techniques/common/light_map/first_order.glsl"
#include "techniques/ort/ort_shared.h"

layout(local_size_x = ORT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    ort_direct_push push_of_all;
};
ort_direct_push push;                                       // a copy, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 6) uniform usampler2D ort_places; // y << 16 | x
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D first_order;

void main()
{
    frame = frame_block;
    push = push_of_all;
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    uint place = texelFetch(ort_places, light_map_at(i), 0).x;
    vec3 irradiance = light_map_first_order(light_map_texel_of(i, push.texels), i, push.texels,
                                            push.sources, push.shadow_radius);
    imageStore(first_order, ivec2(place & 0xffffu, place >> 16),
               vec4(min(irradiance, vec3(HALF_MAX)), 1.0));
}
