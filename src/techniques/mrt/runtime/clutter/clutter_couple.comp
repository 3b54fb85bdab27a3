// couple.comp of a level with clutter. The coefficients of an opening that is clutter are c, the
// radiosity of its faces: of direct light, and of what they reflect of the irradiance E after the
// bounce before. T_b→r gives E of this bounce by walls, to which faces add theirs, as they do to r
// of openings (T_c→r).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/runtime/couple.glsl"

layout(set = 0, binding = 6, scalar) writeonly buffer mrt_r
{
    vec4 r_table[]; // [opening][colour][quad]
};
layout(set = 0, binding = 7, scalar) readonly buffer mrt_clutter_direct
{
    float c_direct[]; // [clutter][colour][face]
};
layout(set = 0, binding = 8, scalar) readonly buffer mrt_clutter_albedo
{
    vec4 albedo[]; // [clutter][colour][quad]
};
layout(set = 0, binding = 9, scalar) readonly buffer mrt_clutter_coupling
{
    vec4 coupling[]; // [pair][face that sends][quad of the opening]
};
layout(set = 0, binding = 10, scalar) readonly buffer mrt_clutter_pairs
{
    mrt_gpu_face_pair pair_table[];
};
layout(set = 0, binding = 11, scalar) readonly buffer mrt_clutter_before
{
    float before[]; // what faces reflect of E after the bounce before: [clutter][colour][face]
};
layout(set = 0, binding = 12, scalar) writeonly buffer mrt_clutter_reflected
{
    vec4 reflected[]; // the same after this bounce: [clutter][colour][quad]
};

// c. Each reader computes it: that is cheaper than barriers around shared memory.
float radiosity_of(uint at)
{
    // Without feedback the last bounce, which may be of no frame, does not count.
    return level.feedback > 0.0 ? c_direct[at] + level.feedback * before[at] : c_direct[at];
}

void add_faces(uint opening, uint quad, uint stripe, uint stripes, inout vec4 sum[3])
{
    uint slots = 4u * QUADS_R, first = opening_table[opening].first_face_pair;
    for (uint i = stripe; i < opening_table[opening].face_pairs * slots; i += stripes) {
        mrt_gpu_face_pair from = pair_table[first + i / slots];
        uint face = i % slots;
        if (face >= 4u * from.quads) continue;
        vec4 weights = coupling[(first * slots + i) * QUADS_R + quad];
        for (uint c = 0u; c < 3u; c++)
            sum[c] += weights * radiosity_of((from.clutter * 3u + c) * slots + face);
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
    uint quad = lane % quads, stripe = lane / quads, stripes = MRT_REDUCE_LOCAL / quads;
    int clutter = opening_table[opening].clutter;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes) {
        add_pairs(opening, quad, stripe, stripes, sum);
        add_faces(opening, quad, stripe, stripes, sum);
    }
    for (int i = 0; i < 3; i++) partial_sums[i][lane] = sum[i];
    barrier();
    if (lane >= 3u * quads) return;
    // Of the quad that this invocation writes: its colour is `stripe`.
    uint at = stripe * QUADS_R + quad, own = uint(max(clutter, 0)) * 3u * QUADS_R + at;
    vec4 arrived = sum_of_stripes(stripe, quad, quads);
    r_table[opening * 3u * QUADS_R + at] = clutter >= 0 ? radiosity_of_quad(own) : arrived;
    if (clutter >= 0) reflected[own] = albedo[own] * arrived;
}
