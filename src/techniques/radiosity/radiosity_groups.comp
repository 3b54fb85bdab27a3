// Radiosity of each group before any bounce: the mean of its clusters by area.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_groups_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_clusters
{
    radiosity_gpu_cluster cluster_table[];
};
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_groups
{
    radiosity_gpu_group group_table[];
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_sent
{
    vec3 sent_table[];
};
layout(set = 0, binding = 3, scalar) writeonly buffer radiosity_group_sent
{
    vec3 group_sent_table[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.groups) return;
    radiosity_gpu_group group = group_table[i];
    vec3 sum = vec3(0.0);
    for (uint c = group.first; c < group.first + group.count; c++)
        sum += cluster_table[c].area_m2 * sent_table[c];
    group_sent_table[i] = group.area_m2 > 0.0 ? sum / group.area_m2 : vec3(0.0);
}
