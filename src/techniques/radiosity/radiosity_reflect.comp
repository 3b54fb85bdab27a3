// Radiosity of each cluster: its own light before any bounce, and what it reflects of its group's.
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
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_group_of
{
    uint group_of_table[];
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_received
{
    vec3 received_table[]; // [groups] irradiance
};
layout(set = 0, binding = 3, scalar) buffer radiosity_sent
{
    vec3 sent_table[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.clusters) return;
    sent_table[i] += cluster_table[i].reflectance * received_table[group_of_table[i]];
}
