// The mean radiosity of direct light of each face of clutter, over its area (Loos 2015, section
// 5.3.2, T_d->c): one workgroup per face.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_TEXELS_BINDING 2
#include "techniques/mrt/runtime/level.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(constant_id = MRT_CONSTANT_QUADS_R) const uint QUADS_R = 8;

layout(set = 0, binding = 3, scalar) readonly buffer mrt_clutter_faces
{
    mrt_gpu_clutter_face face_table[];
};
layout(set = 0, binding = 4, scalar) readonly buffer mrt_direct
{
    vec3 direct_table[];
};
layout(set = 0, binding = 5, scalar) writeonly buffer mrt_clutter_direct
{
    float c_direct[]; // [clutter][colour][slot]
};

shared vec3 sums[MRT_LOCAL];

void main()
{
    mrt_gpu_clutter_face face = face_table[gl_WorkGroupID.x];
    uint lane = gl_LocalInvocationIndex;
    vec3 sum = vec3(0.0);
    for (uint i = lane; i < face.texels; i += MRT_LOCAL)
        sum += texel_table[face.first_texel + i].area_m2 * direct_table[face.first_texel + i];
    sums[lane] = sum;
    barrier();
    if (lane != 0u) return;
    for (uint i = 1u; i < MRT_LOCAL; i++) sum += sums[i];
    for (uint c = 0u; c < 3u; c++)
        c_direct[(face.clutter * 3u + c) * 4u * QUADS_R + face.slot] = face.per_m2 * sum[c];
}
