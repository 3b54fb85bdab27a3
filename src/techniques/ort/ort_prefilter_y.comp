// A level of prefiltered light, then along columns: in pairs, as spread has them.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/ort/ort_shared.h"
#include "techniques/ort/ort_steps.glsl"

layout(local_size_x = ORT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    ort_level_push push;
};
layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D ort_steps;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D ort_filtered;
layout(set = 0, binding = 2, rgba32ui) uniform writeonly uimage2DArray ort_light;

vec3 light_at(int x, int y)
{
    if (x < 0 || x >= int(push.width)) return vec3(0.0);
    float weight[5];
    ort_tap_weights(ort_steps_along(imageLoad(ort_steps, ivec2(y, x)).x, 1), push.stride, weight);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 5; k++) {
        int at = clamp(y + (k - 2) * int(push.stride), 0, int(push.height) - 1);
        sum += weight[k] * imageLoad(ort_filtered, ivec2(at, x)).rgb;
    }
    return sum;
}

void main()
{
    int y = int(gl_GlobalInvocationID.x), x = int(gl_GlobalInvocationID.y) - ORT_MARGIN;
    if (y >= int(push.height)) return;
    vec3 light = light_at(x, y), next = light_at(x + 1, y);
    uvec4 words = uvec4(0u);
    for (int c = 0; c < 3; c++) words[c] = packHalf2x16(vec2(light[c], next[c]));
    imageStore(ort_light, ivec3(y, x + ORT_MARGIN, push.level), words);
}
