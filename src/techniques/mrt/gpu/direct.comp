// Light of each texel before any bounce, and the radiosity of it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_REFLECTOR_LIGHT_BINDING  8
#define MRT_REFLECTOR_SHARES_BINDING 9
#include "techniques/mrt/gpu/direct.glsl"
#include "techniques/mrt/gpu/reflectors.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 6, scalar) writeonly buffer mrt_area_light
{
    vec3 area_light_table[]; // irradiance of emissive surfaces, the sky and reflectors
};
layout(set = 0, binding = 7, scalar) writeonly buffer mrt_direct
{
    vec3 direct_table[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= level.texels) return;
    mrt_texel texel = texel_table[i];
    vec3 area_light = area_light_of(texel.emitted, vec3(texel.sky),
                                    environment_irradiance_at(texel.normal)) +
                      reflected_irradiance(texel.reflected),
         irradiance = area_light;
    add_lights(texel, irradiance);
    area_light_table[i] = area_light;
    direct_table[i] = texel.reflectance * irradiance;
}
