// The mean radiosity of direct light of each face of clutter, over its area (Loos 2015, section
// 5.3.2, T_d->c). Lights and their shadows, reflectors, and the environment by direction, are those
// of a few texels of the face; light of emissive surfaces and the share of the environment are
// means of the table. A workgroup has whole faces.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_REFLECTOR_LIGHT_BINDING  10
#define MRT_REFLECTOR_SHARES_BINDING 11
#include "techniques/mrt/gpu/direct.glsl"
#include "techniques/mrt/gpu/reflectors.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(constant_id = MRT_CONSTANT_QUADS_R) const uint QUADS_R = 8;

layout(set = 0, binding = 6, scalar) readonly buffer mrt_clutter_groups
{
    mrt_gpu_clutter_group group_table[];
};
layout(set = 0, binding = 7, scalar) readonly buffer mrt_clutter_faces
{
    mrt_gpu_clutter_face face_table[];
};
layout(set = 0, binding = 8, scalar) readonly buffer mrt_clutter_samples
{
    mrt_gpu_clutter_sample sample_table[]; // [group][MRT_LOCAL]
};
layout(set = 0, binding = 9, scalar) writeonly buffer mrt_clutter_direct
{
    float c_direct[]; // [clutter][colour][slot]
};

shared float radiosity[MRT_LOCAL * 3];
shared float environment[MRT_LOCAL * 3]; // irradiance of unoccluded texels, times their share

void main()
{
    mrt_gpu_clutter_sample place = sample_table[gl_GlobalInvocationID.x];
    uint lane = gl_LocalInvocationIndex;
    mrt_texel texel = texel_table[place.texel];
    vec3 irradiance = reflected_irradiance(texel.reflected);
    add_lights(texel, irradiance);
    vec3 unoccluded = place.share * environment_irradiance_at(texel.normal);
    for (uint c = 0u; c < 3u; c++) {
        radiosity[3u * lane + c] = place.share * texel.reflectance[c] * irradiance[c];
        environment[3u * lane + c] = unoccluded[c];
    }
    barrier();
    mrt_gpu_clutter_group group = group_table[gl_WorkGroupID.x];
    for (uint i = lane; i < 3u * group.faces; i += MRT_LOCAL) {
        mrt_gpu_clutter_face face = face_table[group.first_face + i / 3u];
        uint c = i % 3u, first = face.first_sample;
        float sum = 0.0, sky = 0.0;
        for (uint k = first; k < first + face.samples; k++) {
            sum += radiosity[3u * k + c];
            sky += environment[3u * k + c];
        }
        sum += area_light_of(face.emitted, face.sky, vec3(sky))[c];
        c_direct[(face.clutter * 3u + c) * 4u * QUADS_R + face.slot] = sum;
    }
}
