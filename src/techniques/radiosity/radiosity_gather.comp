// Light of each texel: F B of the clusters, the sky and emissive surfaces. By colour: irradiance
// along the normal and the vector irradiance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define RADIOSITY_TEXELS_BINDING 1
#include "frame/frame.glsl"
#include "techniques/radiosity/radiosity_row.glsl"
#include "techniques/radiosity/radiosity_texels.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_gather_push push;
};
// [entry][texel of the block]: source and form factor; components along the tangents (halves).
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_factors
{
    uvec2 factor_table[];
};
layout(set = 0, binding = 3, scalar) readonly buffer radiosity_sent
{
    vec3 sent_table[];
};
layout(set = 0, binding = 4, scalar) writeonly buffer radiosity_light
{
    vec4 light_table[]; // [texel][colour]
};

void main()
{
    uint row = gl_GlobalInvocationID.x;
    if (row >= push.count) return;
    uint i = push.first + row;
    radiosity_gpu_texel texel = texel_table[i];
    vec3 irradiance = vec3(0.0), by_u = vec3(0.0), by_v = vec3(0.0);
    for (uint k = 0; k < push.entries; k++) {
        uvec2 word = factor_table[k * push.count + row];
        if (radiosity_has_ended(word.x)) break;
        vec3 light = radiosity_form_factor(word.x) * sent_table[radiosity_source(word.x)];
        vec2 along = unpackHalf2x16(word.y);
        irradiance += light;
        by_u += along.x * light;
        by_v += along.y * light;
    }
    // The tangents of basis_of (core/vec.h).
    vec3 n = texel.normal;
    float side = n.z < 0.0 || (n.z == 0.0 && floatBitsToUint(n.z) != 0u) ? -1.0 : 1.0;
    float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    vec3 u = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
    vec3 v = vec3(b, side + n.y * n.y * a, -n.y);
    for (int c = 0; c < 3; c++)
        light_table[3u * i + c] =
            vec4(irradiance[c], irradiance[c] * n + by_u[c] * u + by_v[c] * v) +
            radiosity_unbounced(texel, c, frame.sky, push.emitters * frame.radiance_scale);
}
