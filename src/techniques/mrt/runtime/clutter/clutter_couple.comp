// couple.comp of a level with clutter. The coefficients of an opening that is clutter are c, the
// radiosity of its faces: of direct light, and of the irradiance E after the bounce before. T_b→r
// gives E of this bounce by walls, to which other faces add theirs.
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
    vec4 coupling[]; // [clutter][face that sends][quad of those that receive]
};
// A group reads and writes E of its own opening only.
layout(set = 0, binding = 10, scalar) buffer mrt_clutter_incident
{
    vec4 incident[]; // [clutter][colour][quad]
};

shared vec4 radiosity[3 * MRT_MAX_QUADS]; // [colour][quad]

vec4 radiosity_of(uint at)
{
    vec4 c = c_direct[at];
    // Without feedback the last bounce, which may be of no frame, does not count.
    if (level.feedback > 0.0) c += level.feedback * albedo[at] * incident[at];
    return c;
}

void add_faces(uint clutter, uint quads, uint quad, uint stripe, uint stripes, inout vec4 sum[3])
{
    for (uint k = stripe; k < 4u * quads; k += stripes) {
        vec4 weights = coupling[(clutter * 4u * QUADS_R + k) * QUADS_R + quad];
        for (uint c = 0u; c < 3u; c++) sum[c] += weights * radiosity[c * QUADS_R + k / 4u][k % 4u];
    }
}

void main()
{
    uint opening = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint quads = opening_table[opening].quads;
    uint quad = lane % quads, stripe = lane / quads, stripes = MRT_REDUCE_LOCAL / quads;
    int clutter = opening_table[opening].clutter;
    bool faces = clutter >= 0, writes = lane < 3u * quads;
    // Of the quad that this invocation writes: its colour is `stripe`.
    uint at = stripe * QUADS_R + quad, own = uint(max(clutter, 0)) * 3u * QUADS_R + at;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) }, c = vec4(0.0);
    if (faces && writes) radiosity[at] = c = radiosity_of(own);
    barrier();
    if (stripe < stripes) add_pairs(opening, quad, stripe, stripes, sum);
    if (stripe < stripes && faces) add_faces(uint(clutter), quads, quad, stripe, stripes, sum);
    for (int i = 0; i < 3; i++) partial_sums[i][lane] = sum[i];
    barrier();
    if (!writes) return;
    vec4 arrived = sum_of_stripes(stripe, quad, quads);
    r_table[opening * 3u * QUADS_R + at] = faces ? c : arrived;
    if (faces) incident[own] = arrived;
}
