// Radiosity of each cluster before any bounce: the mean of its texels, in their order.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_clusters_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_clusters
{
    radiosity_gpu_cluster cluster_table[];
};
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_members
{
    uint member_table[];
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_flux
{
    vec3 flux_table[];
};
layout(set = 0, binding = 3, scalar) writeonly buffer radiosity_sent
{
    vec3 sent_table[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.clusters) return;
    radiosity_gpu_cluster cluster = cluster_table[i];
    vec3 sum = vec3(0.0);
    for (uint k = 0; k < cluster.count; k++) sum += flux_table[member_table[cluster.first + k]];
    sent_table[i] = cluster.area_m2 > 0.0 ? sum / cluster.area_m2 : vec3(0.0);
}
