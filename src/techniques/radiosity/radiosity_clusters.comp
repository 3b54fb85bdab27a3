// Radiosity of each cluster before any bounce: the mean of its texels, in their order.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_pack.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_clusters_push push;
};
layout(set = 0, binding = 0) uniform sampler2D radiosity_clusters; // reflectance, area in m²
layout(set = 0, binding = 1) uniform usampler2D radiosity_spans;   // first member, number
layout(set = 0, binding = 2) uniform usampler2D radiosity_members; // texels
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D radiosity_flux;
layout(set = 0, binding = 4, rg32ui) uniform writeonly uimage2D radiosity_sent;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.clusters) return;
    float area = texelFetch(radiosity_clusters, light_map_at(i), 0).w;
    uvec2 span = texelFetch(radiosity_spans, light_map_at(i), 0).xy;
    vec3 sum = vec3(0.0);
    for (uint k = 0; k < span.y; k++) {
        uint texel = texelFetch(radiosity_members, light_map_at(span.x + k), 0).x;
        sum += imageLoad(radiosity_flux, light_map_at(texel)).rgb;
    }
    vec3 sent = area > 0.0 ? sum / area : vec3(0.0);
    imageStore(radiosity_sent, light_map_at(i), uvec4(radiosity_pack(sent), 0u, 0u));
}
