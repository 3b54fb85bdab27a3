// Light that texels reflect before any bounce, in scaled lumen: radiosity times area.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define SHADOW_FACES_BINDING      2
#define SHADOW_MAPS_BINDING       3
#define SHADOW_SUN_MAPS_BINDING   12
#define LIGHT_MAP_TEXELS_BINDING  4
#define LIGHT_MAP_LIGHTS_BINDING  5
#define LIGHT_MAP_PAINT_BINDING   7
#define LIGHT_MAP_SKY_BINDING     8
#define LIGHT_MAP_PATCHES_BINDING 9
#define FRAME_CONSTANTS_COPIED
#include "techniques/common/light_map/first_order.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_direct_push push_of_all;
};
radiosity_direct_push push; // a copy, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D radiosity_flux;

void main()
{
    frame = frame_block;
    push = push_of_all;
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint i = push.first + gl_GlobalInvocationID.x;
    light_map_texel texel = light_map_texel_of(i, push.texels);
    vec3 irradiance =
        light_map_first_order(texel, i, push.texels, push.sources, push.shadow_radius);
    imageStore(radiosity_flux, light_map_at(i),
               vec4(texel.place.w * texel.reflectance * irradiance, 0.0));
}
