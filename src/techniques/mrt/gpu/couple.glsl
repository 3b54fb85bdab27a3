// Light of b of the blocks that send it to an opening (Loos 2015, section 3.5.3): one workgroup per
// opening, whose invocations have a quad of coefficients and a stripe of the items each.
#ifndef AG_MRT_COUPLE_GLSL
#define AG_MRT_COUPLE_GLSL

#define MRT_OPENINGS_BINDING 2
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/operators.glsl"
#include "techniques/mrt/gpu/reduce.glsl"

layout(local_size_x = MRT_LANES) in;

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

// T_b→r b.
void add_pairs(uint opening, uint quad, uint stripe, uint stripes, inout vec4 sum[3])
{
    uint k_b = 4u * QUADS_B, first = opening_table[opening].first_pair;
    for (uint i = stripe; i < opening_table[opening].pairs * k_b; i += stripes) {
        uint pair = first + i / k_b, mode = i % k_b;
        vec4 weights = MRT_QUAD(t_br, (pair * k_b + mode) * QUADS_R + quad);
        uint at = source_table[pair] * 3u * k_b + mode;
        for (uint c = 0u; c < 3u; c++) sum[c] += weights * b_table[at + c * k_b];
    }
}

#endif
