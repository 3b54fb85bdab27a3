// b = T_d→b l_d of each block for direct radiosity l_d (Loos 2015, equation 3.3): one workgroup per
// block.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_BLOCKS_BINDING 3
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/operators.glsl"
#include "techniques/mrt/gpu/reduce.glsl"

layout(local_size_x = MRT_REDUCE_LOCAL) in;

layout(set = 0, binding = 4, scalar) readonly buffer mrt_direct
{
    vec3 direct_table[];
};
layout(set = 0, binding = 6) readonly buffer mrt_t_db
{
    uint t_db[]; // [row][k_b]
};
layout(set = 0, binding = 7, scalar) writeonly buffer mrt_b_direct
{
    vec4 b_table[]; // [block][colour][quad]
};

void main()
{
    uint block = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint quad = lane % QUADS_B, stripe = lane / QUADS_B, stripes = MRT_REDUCE_LOCAL / QUADS_B;
    uint first = block_table[block].first_texel, row = block_table[block].basis_row;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes)
        for (uint i = stripe; i < block_table[block].texels; i += stripes) {
            vec4 weights = MRT_QUAD(t_db, (row + i) * QUADS_B + quad);
            vec3 radiosity = direct_table[first + i];
            for (int c = 0; c < 3; c++) sum[c] += weights * radiosity[c];
        }
    for (int c = 0; c < 3; c++) partial_sums[c][lane] = sum[c];
    barrier();
    if (lane < 3u * QUADS_B)
        b_table[block * 3u * QUADS_B + lane] =
            sum_of_stripes(lane / QUADS_B, lane % QUADS_B, QUADS_B);
}
