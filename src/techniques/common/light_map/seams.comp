// Light of the places of the light map beside seams: weighted sums of texels, by which lookups on
// both sides of a seam are equal.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/light_map/place.glsl"
#define TEXEL_LIGHT_BINDING 2
#include "techniques/common/light_map/table.glsl"

layout(local_size_x = LIGHT_MAP_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    light_map_seams_push push;
};
layout(set = 0, binding = 0) uniform usampler2D light_map_seam_places;
// [pair][place]: texels and weights; zeros at the end.
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimage2D light_map_seam_rows;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2DArray light_map;

void main()
{
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint i = push.first + gl_GlobalInvocationID.x;
    vec4 light[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint k = 0; k < push.pairs; k++) {
        uvec4 pair = imageLoad(light_map_seam_rows, light_map_at(k * push.places + i));
        vec2 weight = uintBitsToFloat(pair.yw);
        if (weight.x == 0.0) break;
        for (int c = 0; c < int(push.layers); c++) {
            light[c] += weight.x * texel_light_of(pair.x, push.texels, c);
            light[c] += weight.y * texel_light_of(pair.z, push.texels, c);
        }
    }
    uvec3 at = light_map_place(texelFetch(light_map_seam_places, light_map_at(i), 0).x);
    for (int c = 0; c < int(push.layers); c++)
        imageStore(light_map, ivec3(at.xy, int(push.layers) * int(at.z) + c),
                   clamp(light[c], -HALF_MAX, HALF_MAX));
}
