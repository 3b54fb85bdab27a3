// Light of the places of the light map beside seams: weighted sums of texels, by which lookups on
// both sides of a seam are equal.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_seams_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_places
{
    uint place_table[]; // (side · height + y) · width + x
};
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_seam_rows
{
    radiosity_gpu_seam row_table[]; // [entry][place]
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_light
{
    vec4 light_table[];
};
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2DArray light_map;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.places) return;
    vec4 light[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint k = 0; k < push.entries; k++) {
        radiosity_gpu_seam entry = row_table[k * push.places + i];
        if (entry.weight == 0.0) break; // rows end with zeros
        for (int c = 0; c < 3; c++) light[c] += entry.weight * light_table[3u * entry.texel + c];
    }
    uint place = place_table[i], line = place / push.width;
    ivec3 at = ivec3(place % push.width, line % push.height, line / push.height);
    for (int c = 0; c < 3; c++)
        imageStore(light_map, ivec3(at.xy, RADIOSITY_LAYERS * at.z + c),
                   clamp(light[c], -HALF_MAX, HALF_MAX));
}
