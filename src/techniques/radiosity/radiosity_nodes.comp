// Radiosity of groups, nodes of the tree above the clusters: the mean of their clusters by area.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_pack.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_nodes_push push;
};
layout(set = 0, binding = 0) uniform usampler2D radiosity_groups; // node; first cluster and number
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiosity_clusters; // w: area
layout(set = 0, binding = 2, rg32ui) uniform uimage2D radiosity_sent; // clusters, then nodes

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.groups) return;
    uvec2 group = texelFetch(radiosity_groups, light_map_at(i), 0).xy;
    uint first = group.y & ((1u << RADIOSITY_GROUP_SHIFT) - 1u);
    vec3 sum = vec3(0.0);
    float area = 0.0;
    for (uint c = first; c < first + (group.y >> RADIOSITY_GROUP_SHIFT); c++) {
        float weight = imageLoad(radiosity_clusters, light_map_at(c)).w;
        sum += weight * radiosity_unpack(imageLoad(radiosity_sent, light_map_at(c)).xy);
        area += weight;
    }
    vec3 mean = area > 0.0 ? sum / area : vec3(0.0);
    imageStore(radiosity_sent, light_map_at(group.x), uvec4(radiosity_pack(mean), 0u, 0u));
}
