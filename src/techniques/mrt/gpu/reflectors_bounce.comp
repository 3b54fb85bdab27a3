// Radiosity of each reflector of direct light and of what other reflectors send.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_TEXELS_BINDING           2
#define MRT_REFLECTOR_LIGHT_BINDING  3
#define MRT_REFLECTOR_SHARES_BINDING 4
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/reflectors.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 5, scalar) readonly buffer mrt_reflector_direct
{
    vec3 reflector_direct_table[];
};
layout(set = 0, binding = 6, scalar) writeonly buffer mrt_reflector_bounced
{
    vec3 reflector_bounced_table[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= level.reflectors) return;
    reflector_bounced_table[i] =
        reflector_direct_table[i] +
        texel_table[i].reflectance * reflected_irradiance(texel_table[i].reflected);
}
