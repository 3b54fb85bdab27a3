// Light of each texel: form factors times the light of its block's strata, and the sky; emissive
// surfaces and paint only without smoothing, which adds them. By colour: irradiance along the
// normal, vector irradiance and fluence.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define LIGHT_MAP_TEXELS_BINDING  1
#define LIGHT_MAP_PAINT_BINDING   7
#define LIGHT_MAP_SKY_BINDING     8
#define LIGHT_MAP_PATCHES_BINDING 9
#include "core/basis.glsl"
#include "techniques/radiosity/radiosity_pack.glsl"
#include "techniques/common/light_map/texels.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_gather_push push;
};
layout(set = 0, binding = 2) uniform usampler2D radiosity_order; // [row] texel, first stratum
layout(set = 0, binding = 3) uniform usampler2D radiosity_tiles; // first texel, texels of a row
// Pairs of source and form factor; components along the tangents (halves).
layout(set = 0, binding = 4, rgba32ui) uniform readonly uimage2D radiosity_factors;
layout(set = 0, binding = 5, rg32ui) uniform readonly uimage2D radiosity_strata;
layout(set = 0, binding = 6, rg32ui) uniform writeonly uimage2D texel_light;    // [colour][texel]
layout(set = 0, binding = 10, rg32ui) uniform writeonly uimage2D texel_fluence; // [texel]

// Light of strata: irradiance, vector irradiance along the tangents, and fluence.
struct received {
    vec3 irradiance, by_u, by_v, fluence;
};
received sum = received(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

// strata: the first one of the block.
void add_entry(uint strata, uvec2 word)
{
    uvec2 sent = imageLoad(radiosity_strata, light_map_at(strata + radiosity_source(word.x))).xy;
    vec3 light = radiosity_form_factor(word.x) * radiosity_unpack(sent);
    vec2 along = unpackHalf2x16(word.y);
    sum.irradiance += light;
    sum.by_u += along.x * light;
    sum.by_v += along.y * light;
    // Light from one direction: `along` is its tangent, so that this is 1 / cosine.
    sum.fluence += sqrt(1.0 + dot(along, along)) * light;
}

void store_light(uint texel)
{
    mat3 basis = basis_of(light_map_texel_part(texel, push.texels, TEXEL_NORMAL).xyz);
    vec4 sky[3] = light_map_sky_light(texel, push.texels, push.sources);
    vec4 sharp[3] = light_map_sharp_light(texel, push.texels, push.sources);
    for (int c = 0; c < 3; c++) {
        vec4 light = vec4(sum.irradiance[c], sum.irradiance[c] * basis[2] + sum.by_u[c] * basis[0] +
                                                 sum.by_v[c] * basis[1]) +
                     sky[c] + push.sharp * sharp[c];
        imageStore(texel_light, light_map_at(c * push.texels + texel),
                   uvec4(light_map_pack(light), 0u, 0u));
    }
    vec3 fluence = sum.fluence + light_map_sky_fluence(sky, texel, push.texels) +
                   push.sharp * light_map_sharp_fluence(texel, push.texels, push.sources);
    imageStore(texel_fluence, light_map_at(texel),
               uvec4(light_map_pack(vec4(fluence, 0.0)), 0u, 0u));
}

void main()
{
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint row = push.first + gl_GlobalInvocationID.x;
    uvec2 texel = texelFetch(radiosity_order, light_map_at(row), 0).xy;
    uvec2 tile = texelFetch(radiosity_tiles, light_map_at(row / RADIOSITY_TILE), 0).xy;
    for (uint k = 0; k < tile.y; k++) {
        uvec4 pair =
            imageLoad(radiosity_factors, light_map_at(radiosity_row_texel(tile.x, k, row)));
        add_entry(texel.y, pair.xy);
        add_entry(texel.y, pair.zw);
    }
    store_light(texel.x);
}
