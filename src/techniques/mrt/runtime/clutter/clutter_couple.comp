// couple.comp of a level with clutter. The coefficients of an opening that is clutter are c, the
// radiosity of its faces: of direct light, and of the irradiance E after the bounce before. T_b→r
// gives E of this bounce by walls, to which faces add theirs, as they do to r of openings (T_c→r).
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
    vec4 c_direct[]; // [clutter][colour][quad]
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
    vec4 before[]; // E after the bounce before: [clutter][colour][quad]
};
layout(set = 0, binding = 12, scalar) writeonly buffer mrt_clutter_incident
{
    vec4 incident[];
};

shared vec4 radiosity[3 * MRT_MAX_QUADS]; // [colour][quad]

vec4 radiosity_of(uint at)
{
    vec4 c = c_direct[at];
    // Without feedback the last bounce, which may be of no frame, does not count.
    if (level.feedback > 0.0) c += level.feedback * albedo[at] * before[at];
    return c;
}

// All invocations of the group call this together.
void add_faces(uint pair, bool used, uint quad, uint stripe, uint stripes, inout vec4 sum[3])
{
    mrt_gpu_face_pair from = pair_table[pair];
    uint lane = gl_LocalInvocationIndex;
    barrier();
    if (lane < 3u * QUADS_R) radiosity[lane] = radiosity_of(from.clutter * 3u * QUADS_R + lane);
    barrier();
    for (uint k = stripe; k < 4u * from.quads && used; k += stripes) {
        vec4 weights = coupling[(pair * 4u * QUADS_R + k) * QUADS_R + quad];
        for (uint c = 0u; c < 3u; c++) sum[c] += weights * radiosity[c * QUADS_R + k / 4u][k % 4u];
    }
}

void main()
{
    uint opening = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint quads = opening_table[opening].quads, first = opening_table[opening].first_face_pair;
    uint quad = lane % quads, stripe = lane / quads, stripes = MRT_REDUCE_LOCAL / quads;
    int clutter = opening_table[opening].clutter;
    bool faces = clutter >= 0, writes = lane < 3u * quads;
    // Of the quad that this invocation writes: its colour is `stripe`.
    uint at = stripe * QUADS_R + quad, own = uint(max(clutter, 0)) * 3u * QUADS_R + at;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes) add_pairs(opening, quad, stripe, stripes, sum);
    for (uint i = 0u; i < opening_table[opening].face_pairs; i++)
        add_faces(first + i, stripe < stripes, quad, stripe, stripes, sum);
    for (int i = 0; i < 3; i++) partial_sums[i][lane] = sum[i];
    barrier();
    if (!writes) return;
    vec4 arrived = sum_of_stripes(stripe, quad, quads);
    r_table[opening * 3u * QUADS_R + at] = faces ? radiosity_of(own) : arrived;
    if (faces) incident[own] = arrived;
}
