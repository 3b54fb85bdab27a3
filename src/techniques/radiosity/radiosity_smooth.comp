// The light of a texel: the mean of its own and that of its neighbours in the chart, as far as
// nothing is near. Each texel's row is a choice of its own among the clusters that its rays met;
// neighbours choose others, and see nearly the same.
//
// With R the harmonic mean of the distances of what a texel sees, irradiance at distance d differs
// by about d/R (Ward, Rubinstein & Clear 1988, "A Ray Tracing Solution for Diffuse
// Interreflection"): weights fall to 0 where that is ¼.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_smooth_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_points
{
    radiosity_gpu_point point_table[];
};
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_owners
{
    uint owner_table[]; // [side][y][x]
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_light
{
    vec4 light_table[];
};
layout(set = 0, binding = 3, scalar) writeonly buffer radiosity_smoothed
{
    vec4 smoothed_table[];
};

float weight_of(radiosity_gpu_point a, radiosity_gpu_point b)
{
    float per_m = max(a.inverse_distance, b.inverse_distance);
    return max(1.0 - 4.0 * distance(a.position, b.position) * per_m, 0.0);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    radiosity_gpu_point own = point_table[i];
    vec4 sum[3] = vec4[3](light_table[3u * i], light_table[3u * i + 1u], light_table[3u * i + 2u]);
    float weights = 1.0;
    for (int k = 0; k < 9; k++) {
        int to = int(own.place) + (k / 3 - 1) * int(push.width) + k % 3 - 1;
        uint other = owner_table[to];
        if (other == 0xffffffffu || other == i) continue;
        float weight = weight_of(own, point_table[other]);
        weights += weight;
        for (int c = 0; c < 3; c++) sum[c] += weight * light_table[3u * other + c];
    }
    for (int c = 0; c < 3; c++) smoothed_table[3u * i + c] = sum[c] / weights;
}
