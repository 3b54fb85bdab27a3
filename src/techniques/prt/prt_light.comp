// Light of each texel: distant light by its transfer vector, and that of emissive surfaces. Vectors
// have no directions: their vector irradiance is along the normal.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#if PRT_COMPRESSED
#include "techniques/prt/prt_clusters.glsl"
#else
#include "techniques/prt/prt_transfer.glsl"
#endif

layout(local_size_x = PRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    prt_light_push push;
};
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D prt_texels;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D texel_light; // [colour][texel]

vec4 texel_part(uint texel, int part)
{
    return imageLoad(prt_texels, light_map_at(part * push.texels + texel));
}

vec3 texel_irradiance(uint texel)
{
#if PRT_COMPRESSED
    return prt_cluster_irradiance(texel, push.texels);
#else
    return prt_row_irradiance(texel, push.texels);
#endif
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    vec3 normal = texel_part(i, TEXEL_NORMAL).xyz;
    // Sums of few bands ring below 0.
    vec3 irradiance = max(texel_irradiance(i), vec3(0.0));
    for (int c = 0; c < 3; c++) {
        vec4 sum = vec4(irradiance[c], irradiance[c] * normal);
        sum += texel_part(i, TEXEL_EMITTED_0 + c) * push.emitters;
        imageStore(texel_light, light_map_at(c * push.texels + i),
                   uvec4(light_map_pack(sum), 0u, 0u));
    }
}
