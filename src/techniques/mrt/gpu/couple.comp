// r = T_b→r b of each opening, over the blocks that send light to it (Loos 2015, section 3.5.3).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/gpu/couple.glsl"

layout(set = 0, binding = 6, scalar) writeonly buffer mrt_r
{
    vec4 r_table[]; // [opening][colour][quad]
};

void main()
{
    uint opening = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint quad = lane % QUADS_R, stripe = lane / QUADS_R, stripes = MRT_REDUCE_LOCAL / QUADS_R;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes) add_pairs(opening, quad, stripe, stripes, sum);
    for (int c = 0; c < 3; c++) partial_sums[c][lane] = sum[c];
    barrier();
    if (lane < 3u * QUADS_R)
        r_table[opening * 3u * QUADS_R + lane] =
            sum_of_stripes(lane / QUADS_R, lane % QUADS_R, QUADS_R);
}
