// Radiosity of the strata of blocks: the mean of their sources by what rays of the block meet.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_pack.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_strata_push push;
};
layout(set = 0, binding = 0) uniform usampler2D radiosity_order; // [row] stratum
layout(set = 0, binding = 1) uniform usampler2D radiosity_tiles; // first texel, texels of a row
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2D radiosity_factors;
layout(set = 0, binding = 3, rg32ui) uniform readonly uimage2D radiosity_sent;
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D radiosity_strata;

vec3 light_of(uint word)
{
    uvec2 sent = imageLoad(radiosity_sent, light_map_at(radiosity_source(word))).xy;
    return radiosity_form_factor(word) * radiosity_unpack(sent);
}

void main()
{
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint row = push.first + gl_GlobalInvocationID.x;
    uvec2 tile = texelFetch(radiosity_tiles, light_map_at(row / RADIOSITY_TILE), 0).xy;
    vec3 sum = vec3(0.0);
    for (uint k = 0; k < tile.y; k++) {
        uvec4 words =
            imageLoad(radiosity_factors, light_map_at(radiosity_row_texel(tile.x, k, row)));
        for (int j = 0; j < RADIOSITY_QUAD; j++) sum += light_of(words[j]);
    }
    ivec2 at = light_map_at(texelFetch(radiosity_order, light_map_at(row), 0).x);
    imageStore(radiosity_strata, at, uvec4(radiosity_pack(sum), 0u, 0u));
}
