// The b-coefficients after one more bounce, in the reduced spaces: those of direct light, plus
// those of the light that the block's walls reflect of b and of r, the light that enters by its
// openings.
//
// Each block has the operator T_d→b ρ [U_b | U_r …] for each colour, by its own reflectance: the
// same light as from the irradiance of all texels, without it. One workgroup per block.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_BLOCKS_BINDING 2
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/operators.glsl"
#include "techniques/mrt/gpu/reduce.glsl"

layout(local_size_x = MRT_REDUCE_LOCAL) in;

layout(set = 0, binding = 3, scalar) readonly buffer mrt_reflection
{
    vec4 reflection[]; // [column][colour][quad]
};
layout(set = 0, binding = 4, scalar) readonly buffer mrt_b_direct
{
    vec4 b_direct[]; // [block][colour][quad]
};
layout(set = 0, binding = 5, scalar) readonly buffer mrt_r
{
    float r_table[]; // [opening][colour][k_r]
};
// A group reads and writes the coefficients of its own block only.
layout(set = 0, binding = 6, scalar) buffer mrt_b
{
    float b_table[]; // [block][colour][k_b]
};

void main()
{
    uint block = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint quad = lane % QUADS_B, stripe = lane / QUADS_B, stripes = MRT_REDUCE_LOCAL / QUADS_B;
    uint k_b = 4u * QUADS_B, k_r = 4u * QUADS_R, opening = block_table[block].first_opening;
    uint first = block * k_b + opening * k_r;
    uint columns = level.feedback > 0.0 ? block_table[block].columns : 0u;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes)
        for (uint i = stripe; i < columns; i += stripes)
            for (uint c = 0u; c < 3u; c++) {
                uint entered = i - k_b;
                float value =
                    i < k_b ? b_table[(block * 3u + c) * k_b + i]
                            : r_table[((opening + entered / k_r) * 3u + c) * k_r + entered % k_r];
                sum[c] += value * reflection[((first + i) * 3u + c) * QUADS_B + quad];
            }
    for (int c = 0; c < 3; c++) partial_sums[c][lane] = sum[c];
    barrier();
    if (lane >= 3u * QUADS_B) return;
    uint at = block * 3u * QUADS_B + lane;
    vec4 b =
        b_direct[at] + level.feedback * sum_of_stripes(lane / QUADS_B, lane % QUADS_B, QUADS_B);
    for (uint k = 0u; k < 4u; k++) b_table[4u * at + k] = b[k];
}
