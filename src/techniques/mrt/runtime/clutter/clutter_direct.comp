// The mean radiosity of direct light of each face of clutter, over its area (Loos 2015, section
// 5.3.2, T_d->c), and emissive surfaces and the sky at its texels: one workgroup per face. Lights
// and their shadows are those of a few texels of the face.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/runtime/direct.glsl"

layout(local_size_x = MRT_FACE_SAMPLES) in;

layout(constant_id = MRT_CONSTANT_QUADS_R) const uint QUADS_R = 8;

layout(set = 0, binding = 7, scalar) readonly buffer mrt_clutter_faces
{
    mrt_gpu_clutter_face face_table[];
};
layout(set = 0, binding = 8, scalar) readonly buffer mrt_clutter_samples
{
    mrt_gpu_clutter_sample sample_table[]; // [face][MRT_FACE_SAMPLES]
};
layout(set = 0, binding = 9, scalar) writeonly buffer mrt_clutter_direct
{
    float c_direct[]; // [clutter][colour][slot]
};

shared vec3 sums[MRT_FACE_SAMPLES];

vec3 light_of_samples()
{
    mrt_gpu_clutter_sample place = sample_table[gl_GlobalInvocationID.x];
    vec3 irradiance = vec3(0.0);
    if (place.share == 0.0) return irradiance;
    mrt_texel texel = texel_table[place.texel];
    add_lights(texel, irradiance);
    return place.share * texel.albedo * irradiance;
}

void main()
{
    mrt_gpu_clutter_face face = face_table[gl_WorkGroupID.x];
    uint lane = gl_LocalInvocationIndex;
    vec3 sum = light_of_samples();
    for (uint i = face.first_texel + lane; i < face.first_texel + face.texels;
         i += MRT_FACE_SAMPLES) {
        mrt_texel texel = texel_table[i];
        vec3 unbounced = unbounced_of(texel);
        unbounced_table[i] = unbounced;
        sum += (face.per_m2 * texel.area_m2) * texel.albedo * unbounced;
    }
    sums[lane] = sum;
    barrier();
    if (lane != 0u) return;
    for (uint i = 1u; i < MRT_FACE_SAMPLES; i++) sum += sums[i];
    for (uint c = 0u; c < 3u; c++)
        c_direct[(face.clutter * 3u + c) * 4u * QUADS_R + face.slot] = sum[c];
}
