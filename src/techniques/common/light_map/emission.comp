// Light of emissive surfaces at texels: columns of the bake, weighted by the emission of materials.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/light_map/table.glsl"

layout(local_size_x = LIGHT_MAP_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    light_map_emission_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer light_map_emission_weights
{
    vec4 weight_table[]; // [column] by colour, cd/m²
};
// [column][texel]: irradiance along the normal, vector irradiance: radiance 1;
// [column / 4][texel]: fluence of four columns
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D light_map_emission;
layout(set = 0, binding = 2, rgba32f) uniform image2D light_map_texels;

// The part of the sky stays.
void add_fluence(uint i)
{
    uint part = TEXEL_FLUENCE * push.texels + i, first = push.columns * push.texels + i;
    vec4 fluence = vec4(vec3(0.0), imageLoad(light_map_texels, light_map_at(part)).w);
    for (uint k = 0u; k < push.columns; k++) {
        vec4 four = imageLoad(light_map_emission, light_map_at(first + k / 4u * push.texels));
        fluence.rgb += four[k % 4u] * weight_table[k].rgb;
    }
    imageStore(light_map_texels, light_map_at(part), fluence);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    vec4 light[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint k = 0u; k < push.columns; k++) {
        vec4 column = imageLoad(light_map_emission, light_map_at(k * push.texels + i));
        for (int c = 0; c < 3; c++) light[c] += weight_table[k][c] * column;
    }
    for (int c = 0; c < 3; c++) {
        uint part = TEXEL_EMITTED_0 + c;
        imageStore(light_map_texels, light_map_at(part * push.texels + i), light[c]);
    }
    if (push.fluence != 0u) add_fluence(i);
}
