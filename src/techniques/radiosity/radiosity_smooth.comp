// The light of clusters and of the sky at a texel: the mean of its own and that of its neighbours
// in the chart, as far as nothing is near. Each texel's row is a choice of its own among the
// clusters that its rays met; neighbours choose others, and see nearly the same. The last pass adds
// the light of emissive surfaces and of paint, which are sampled well and may have sharp edges.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define TEXEL_LIGHT_BINDING       1
#define LIGHT_MAP_TEXELS_BINDING  3
#define LIGHT_MAP_PAINT_BINDING   4
#define LIGHT_MAP_SKY_BINDING     5
#define LIGHT_MAP_PATCHES_BINDING 6
#include "techniques/common/light_map/texels.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_smooth_push push;
};
// [pass][pair][texel]: texels and weights; zeros at the end.
layout(set = 0, binding = 7, rgba32ui) uniform readonly uimage2D radiosity_neighbours;
layout(set = 0, binding = 2, rg32ui) uniform writeonly uimage2D radiosity_smoothed;
layout(set = 0, binding = 8, rg32ui) uniform readonly uimage2D texel_fluence; // [texel]
layout(set = 0, binding = 9, rg32ui) uniform writeonly uimage2D radiosity_smoothed_fluence;

vec3 fluence_of(uint texel)
{
    return light_map_unpack(imageLoad(texel_fluence, light_map_at(texel)).xy).rgb;
}

const uint PAIRS = RADIOSITY_NEIGHBOURS / LIGHT_MAP_PAIR;

void main()
{
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint i = push.first + gl_GlobalInvocationID.x;
    vec4 sum[3];
    vec3 fluence = fluence_of(i);
    for (int c = 0; c < 3; c++) sum[c] = texel_light_of(i, push.texels, c);
    float weights = 1.0;
    for (uint k = 0; k < PAIRS; k++) {
        uint row = push.pass * PAIRS + k;
        uvec4 pair = imageLoad(radiosity_neighbours, light_map_at(row * push.texels + i));
        if (pair.y == 0u) break;
        vec2 weight = uintBitsToFloat(pair.yw);
        weights += weight.x;
        weights += weight.y;
        fluence += weight.x * fluence_of(pair.x) + weight.y * fluence_of(pair.z);
        for (int c = 0; c < 3; c++) {
            sum[c] += weight.x * texel_light_of(pair.x, push.texels, c);
            sum[c] += weight.y * texel_light_of(pair.z, push.texels, c);
        }
    }
    vec4 sharp[3] = light_map_sharp_light(i, push.texels, push.sources);
    for (int c = 0; c < 3; c++)
        imageStore(radiosity_smoothed, light_map_at(c * push.texels + i),
                   uvec4(light_map_pack(sum[c] / weights + push.sharp * sharp[c]), 0u, 0u));
    fluence =
        fluence / weights + push.sharp * light_map_sharp_fluence(i, push.texels, push.sources);
    imageStore(radiosity_smoothed_fluence, light_map_at(i),
               uvec4(light_map_pack(vec4(fluence, 0.0)), 0u, 0u));
}
