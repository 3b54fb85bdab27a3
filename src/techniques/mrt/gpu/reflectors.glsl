// Light that reflectors send (light/reflectors.h). Needs MRT_REFLECTOR_LIGHT_BINDING and
// MRT_REFLECTOR_SHARES_BINDING.
#ifndef AG_MRT_REFLECTORS_GLSL
#define AG_MRT_REFLECTORS_GLSL

#include "core/sh.glsl"
#include "frame/octahedral.glsl"
#include "techniques/mrt/mrt_shared.h"

layout(set = 0, binding = MRT_REFLECTOR_LIGHT_BINDING, scalar) readonly buffer mrt_reflector_light
{
    vec3 reflector_light_table[]; // radiosity
};
layout(set = 0, binding = MRT_REFLECTOR_SHARES_BINDING, scalar) readonly buffer mrt_reflector_shares
{
    mrt_gpu_reflector_share reflector_share_table[];
};

// Irradiance at a texel.
vec3 reflected_irradiance(mrt_gpu_reflector_row row)
{
    vec3 sum = vec3(0.0);
    for (uint k = row.first; k < row.first + row.count; k++)
        sum += reflector_share_table[k].weight *
               reflector_light_table[reflector_share_table[k].reflector];
    return sum;
}

// Vector irradiance at a texel, a column for each colour.
void add_reflected_vector(mrt_gpu_reflector_row row, vec3 normal, inout mat3 vector)
{
    const float LEAST_COSINE = 1e-3; // of rays of texels
    for (uint k = row.first; k < row.first + row.count; k++) {
        mrt_gpu_reflector_share share = reflector_share_table[k];
        vec3 way = octahedral_decode(unpackSnorm2x16(share.direction));
        way *= share.weight / max(dot(way, normal), LEAST_COSINE);
        vector += outerProduct(way, reflector_light_table[share.reflector]);
    }
}

// Irradiance by normal at a point.
void add_reflected(mrt_gpu_reflector_row row, inout vec3 coefficients[9])
{
    for (uint k = row.first; k < row.first + row.count; k++) {
        mrt_gpu_reflector_share share = reflector_share_table[k];
        float transfer[9];
        sh9_clamped_cosine(octahedral_decode(unpackSnorm2x16(share.direction)), transfer);
        vec3 light = share.weight * reflector_light_table[share.reflector];
        for (int i = 0; i < 9; i++) coefficients[i] += transfer[i] * light;
    }
}

#endif
