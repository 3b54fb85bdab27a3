// Light in pairs: a texel and the next one of its row, by colour.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/ort/ort_shared.h"

layout(local_size_x = ORT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    ort_spread_push push;
};
layout(set = 0, binding = 0) uniform sampler2D first_order;
layout(set = 0, binding = 1, rgba32ui) uniform writeonly uimage2DArray ort_light;

vec3 light_at(int x, int y)
{
    return x >= 0 && x < int(push.width) ? texelFetch(first_order, ivec2(x, y), 0).rgb : vec3(0.0);
}

void main()
{
    int y = int(gl_GlobalInvocationID.x), x = int(gl_GlobalInvocationID.y) - ORT_MARGIN;
    if (y >= int(push.height)) return;
    vec3 light = light_at(x, y), next = light_at(x + 1, y);
    uvec4 words = uvec4(0u);
    for (int c = 0; c < 3; c++) words[c] = packHalf2x16(vec2(light[c], next[c]));
    imageStore(ort_light, ivec3(y, x + ORT_MARGIN, 0), words);
}
