// Light of each vertex: distant light by its transfer vector, and that of emissive surfaces.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#if PRT_COMPRESSED
#include "techniques/prt/prt_clusters.glsl"
#else
#include "techniques/prt/prt_transfer.glsl"
#endif
#include "techniques/prt/prt_vertex.glsl"

layout(local_size_x = PRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    prt_light_push push; // texels: vertices
};
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D prt_texels;
layout(set = 0, binding = 3, rgba32ui) uniform writeonly uimage2D vertex_light; // [part][vertex]

vec4 vertex_part(uint vertex, int part)
{
    return imageLoad(prt_texels, light_map_at(part * push.texels + vertex));
}

vec3 vertex_irradiance(uint vertex)
{
#if PRT_COMPRESSED
    return prt_cluster_irradiance(vertex, push.texels);
#else
    return prt_row_irradiance(vertex, push.texels);
#endif
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    prt_vertex_light light = prt_vertex_dark();
    light.normal = vertex_part(i, PRT_VERTEX_NORMAL).xyz;
    // Sums of few bands ring below 0.
    light.irradiance = max(vertex_irradiance(i), vec3(0.0));
    for (int c = 0; c < 3 && EMITTED; c++) {
        vec4 part = vertex_part(i, PRT_VERTEX_EMITTED_0 + c) * push.emitters;
        light.irradiance[c] += part.w;
        light.beside[c] = clamp(part.xyz, -HALF_MAX, HALF_MAX);
    }
    light.irradiance = min(light.irradiance, HALF_MAX);
    imageStore(vertex_light, light_map_at(i), prt_vertex_pack_0(light));
    if (EMITTED) imageStore(vertex_light, light_map_at(push.texels + i), prt_vertex_pack_1(light));
}
