// couple.comp of a level with clutter: r = T_b→r b + T_c→r c. The coefficients of an opening that
// is clutter are c, the radiosity of its faces: that of direct light, and the reflected irradiance
// E after the bounce before. E of this bounce, C_b b + C_c c, is summed as r is.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_LANES MRT_CLUTTER_LOCAL
#include "techniques/mrt/gpu/couple.glsl"

layout(set = 0, binding = 6, scalar) writeonly buffer mrt_r
{
    vec4 r_table[]; // [opening][colour][quad]
};
layout(set = 0, binding = 7, scalar) readonly buffer mrt_clutter_direct
{
    float c_direct[]; // [clutter][colour][face]
};
layout(set = 0, binding = 8, scalar) readonly buffer mrt_clutter_reflectance
{
    vec4 reflectance[]; // [clutter][colour][quad]
};
layout(set = 0, binding = 9) readonly buffer mrt_clutter_coupling
{
    uint coupling[]; // [sender of an opening][k_r]
};
layout(set = 0, binding = 10) readonly buffer mrt_clutter_senders
{
    uint sender_table[]; // [sender of an opening]: its face in c_direct, of red
};
layout(set = 0, binding = 11, scalar) readonly buffer mrt_clutter_before
{
    float before[]; // reflected E of faces after the bounce before: [clutter][colour][face]
};
layout(set = 0, binding = 12, scalar) writeonly buffer mrt_clutter_reflected
{
    vec4 reflected[]; // the same after this bounce: [clutter][colour][quad]
};

// c. Each reader computes it: that is cheaper than a pass. Without feedback the last bounce, which
// may be of no frame, does not count.
float radiosity_of(uint at)
{
    float direct = c_direct[at], bounced = direct + level.feedback * before[at];
    return level.feedback > 0.0 ? bounced : direct;
}

void add_senders(uint opening, uint quad, uint stripe, uint stripes, inout vec4 sum[3])
{
    uint end = opening_table[opening].first_sender + opening_table[opening].senders;
    for (uint i = opening_table[opening].first_sender + stripe; i < end; i += stripes) {
        vec4 weights = MRT_QUAD(coupling, i * QUADS_R + quad);
        uint at = sender_table[i];
        for (uint c = 0u; c < 3u; c++) sum[c] += weights * radiosity_of(at + c * 4u * QUADS_R);
    }
}

vec4 radiosity_of_quad(uint quad)
{
    return vec4(radiosity_of(4u * quad), radiosity_of(4u * quad + 1u), radiosity_of(4u * quad + 2u),
                radiosity_of(4u * quad + 3u));
}

void main()
{
    uint opening = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint quads = opening_table[opening].quads;
    uint quad = lane % quads, stripe = lane / quads, stripes = MRT_LANES / quads;
    int clutter = opening_table[opening].clutter;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes) {
        add_pairs(opening, quad, stripe, stripes, sum);
        add_senders(opening, quad, stripe, stripes, sum);
    }
    for (int i = 0; i < 3; i++) partial_sums[i][lane] = sum[i];
    barrier();
    if (lane >= 3u * quads) return;
    // The quad that this invocation writes; its colour is `stripe`.
    uint at = stripe * QUADS_R + quad, own = uint(max(clutter, 0)) * 3u * QUADS_R + at;
    vec4 arrived = sum_of_stripes(stripe, quad, quads);
    r_table[opening * 3u * QUADS_R + at] = clutter >= 0 ? radiosity_of_quad(own) : arrived;
    if (clutter >= 0) reflected[own] = reflectance[own] * arrived;
}
