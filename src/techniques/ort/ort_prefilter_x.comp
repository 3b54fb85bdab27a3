// A level of prefiltered light, first along rows.
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
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimage2DArray ort_light;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D ort_filtered;

// The first of a pair of ort_light.
vec3 light_at(int x, int y)
{
    uvec3 words = imageLoad(ort_light, ivec3(y, x + ORT_MARGIN, push.level - 1)).xyz;
    return vec3(unpackHalf2x16(words.x).x, unpackHalf2x16(words.y).x, unpackHalf2x16(words.z).x);
}

void main()
{
    int y = int(gl_GlobalInvocationID.x), x = int(gl_GlobalInvocationID.y);
    if (y >= int(push.height)) return;
    float weight[5];
    ort_tap_weights(ort_steps_along(imageLoad(ort_steps, ivec2(y, x)).x, 0), push.stride, weight);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 5; k++) {
        int at = clamp(x + (k - 2) * int(push.stride), 0, int(push.width) - 1);
        sum += weight[k] * light_at(at, y);
    }
    imageStore(ort_filtered, ivec2(y, x), vec4(sum, 1.0));
}
