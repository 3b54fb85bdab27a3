// Radiosity of each reflector of direct light.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/gpu/direct.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 6, scalar) writeonly buffer mrt_reflector_direct
{
    vec3 reflector_direct_table[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= level.reflectors) return;
    mrt_texel texel = texel_table[i];
    vec3 irradiance =
        area_light_of(texel.emitted, vec3(texel.sky), environment_irradiance_at(texel.normal));
    add_lights(texel, irradiance);
    reflector_direct_table[i] = texel.reflectance * irradiance;
}
