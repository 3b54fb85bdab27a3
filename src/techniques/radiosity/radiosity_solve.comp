// One step of the Chebyshev semi-iterative method (Golub & Van Loan 2013, section 11.2.8) for
// B = B0 + ρ F B over the clusters: B′ = ω (B0 + ρ F B − B_before) + B_before. ω = 1 is a bounce.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_pack.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_solve_push push;
};
layout(set = 0, binding = 0) uniform sampler2D radiosity_clusters; // reflectance, area in m²
layout(set = 0, binding = 1) uniform usampler2D radiosity_order;   // [row] cluster
layout(set = 0, binding = 2) uniform usampler2D radiosity_tiles;   // first texel, texels of a row
layout(set = 0, binding = 3, rgba32ui) uniform readonly uimage2D radiosity_factors;
layout(set = 0, binding = 4) uniform usampler2D radiosity_sent;                // B0
layout(set = 0, binding = 5, rg32ui) uniform readonly uimage2D radiosity_last; // B
layout(set = 0, binding = 6, rg32ui) uniform uimage2D radiosity_next; // B_before, then B′

vec3 light_of(uint word)
{
    uvec2 sent = imageLoad(radiosity_last, light_map_at(radiosity_source(word))).xy;
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
    vec3 reflectance = texelFetch(radiosity_clusters, at, 0).rgb;
    vec3 bounced = radiosity_unpack(texelFetch(radiosity_sent, at, 0).xy) + reflectance * sum;
    vec3 before = push.over == 1.0 ? vec3(0.0) : radiosity_unpack(imageLoad(radiosity_next, at).xy);
    vec3 next = push.over * (bounced - before) + before;
    imageStore(radiosity_next, at, uvec4(radiosity_pack(next), 0u, 0u));
}
