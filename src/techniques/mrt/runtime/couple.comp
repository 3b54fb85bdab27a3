// r = T_b→r b of each opening, over the blocks that send light to it (Loos 2015, section 3.5.3):
// one workgroup per opening.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_OPENINGS_BINDING 2
#include "techniques/mrt/runtime/level.glsl"
#include "techniques/mrt/runtime/operators.glsl"
#include "techniques/mrt/runtime/reduce.glsl"

layout(local_size_x = MRT_REDUCE_LOCAL) in;

layout(set = 0, binding = 3) readonly buffer mrt_sources
{
    uint source_table[]; // of each pair: the block
};
layout(set = 0, binding = 4) readonly buffer mrt_t_br
{
    uint t_br[]; // [pair][k_b][k_r]
};
layout(set = 0, binding = 5, scalar) readonly buffer mrt_b
{
    float b_table[]; // [block][colour][k_b]
};
layout(set = 0, binding = 6, scalar) writeonly buffer mrt_r
{
    vec4 r_table[]; // [opening][colour][quad]
};

void main()
{
    uint opening = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex, k_b = 4u * QUADS_B;
    uint quad = lane % QUADS_R, stripe = lane / QUADS_R, stripes = MRT_REDUCE_LOCAL / QUADS_R;
    uint first = opening_table[opening].first_pair;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes)
        for (uint i = stripe; i < opening_table[opening].pairs * k_b; i += stripes) {
            uint pair = first + i / k_b, mode = i % k_b;
            vec4 weights = MRT_QUAD(t_br, (pair * k_b + mode) * QUADS_R + quad);
            uint at = source_table[pair] * 3u * k_b + mode;
            for (uint c = 0u; c < 3u; c++) sum[c] += weights * b_table[at + c * k_b];
        }
    for (int c = 0; c < 3; c++) partial_sums[c][lane] = sum[c];
    barrier();
    if (lane < 3u * QUADS_R)
        r_table[opening * 3u * QUADS_R + lane] =
            sum_of_stripes(lane / QUADS_R, lane % QUADS_R, QUADS_R);
}
