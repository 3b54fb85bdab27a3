// Radiosity of the nodes above the clusters: the mean of their clusters by area.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_nodes_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_clusters
{
    radiosity_gpu_cluster cluster_table[];
};
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_nodes
{
    radiosity_gpu_node node_table[];
};
layout(set = 0, binding = 2, scalar) buffer radiosity_sent
{
    vec3 sent_table[]; // clusters, then nodes
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.nodes) return;
    radiosity_gpu_node node = node_table[i];
    vec3 sum = vec3(0.0);
    float area = 0.0;
    for (uint c = node.first; c < node.first + node.count; c++) {
        sum += cluster_table[c].area_m2 * sent_table[c];
        area += cluster_table[c].area_m2;
    }
    sent_table[push.clusters + i] = area > 0.0 ? sum / area : vec3(0.0);
}
