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
    mrt_gpu_area_light area_light_table[];
};
layout(set = 0, binding = 7, scalar) writeonly buffer mrt_direct
{
    vec3 direct_table[];
};

// A column for each colour.
mat3 area_light_vector(mrt_texel texel, vec3 environment)
{
    float emitters = frame.radiance_scale * level.emitters;
    mat3 sum = outerProduct(texel.sky_vector, environment);
    for (int c = 0; c < 3; c++) sum[c] += emitters * texel.emitted_vector[c];
    add_reflected_vector(texel.reflected, texel.normal, sum);
    return sum;
}

mrt_gpu_area_light area_light_at(mrt_texel texel)
{
    vec3 environment = environment_irradiance_at(texel.normal);
    vec3 across = octahedral_decode(unpackSnorm2x16(texel.across));
    mat3 vector = area_light_vector(texel, environment);
    mrt_gpu_area_light light;
    light.irradiance = area_light_of(texel.emitted, vec3(texel.sky), environment) +
                       reflected_irradiance(texel.reflected);
    light.hidden = texel.hidden;
    light.along[0] = across * vector;
    light.along[1] = cross(texel.normal, across) * vector;
    return light;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= level.texels) return;
    mrt_texel texel = texel_table[i];
    mrt_gpu_area_light area_light = area_light_at(texel);
    vec3 irradiance = area_light.irradiance;
    add_lights(texel, irradiance);
    area_light_table[i] = area_light;
    direct_table[i] = texel.reflectance * irradiance;
}
