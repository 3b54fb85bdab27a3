// Marks the nodes at a depth that will have a brick: every voxel marks the nodes that contain or
// touch its point (Hong 2015, sec. 2.5.3.2.4). A point on a border is in up to eight bricks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/octree/octree_shared.h"

layout(local_size_x = VCT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_svo_push push;
};
layout(set = 0, binding = 1, scalar) readonly buffer vct_list
{
    uint list[];
};
layout(set = 0, binding = 2, scalar) readonly buffer vct_arguments
{
    uint groups[3];
    uint listed;
    uint overflow;
};
layout(set = 0, binding = 3, scalar) buffer vct_svo_nodes
{
    uint nodes[];
};

#include "techniques/vct/octree/octree.glsl"

void main()
{
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= listed) return;
    ivec3 point = (vct_voxel_of_face(list[slot]) + 1) >> 1;
    int height = int(svo.depths - 1u - push.depth);
    ivec3 low = max((point - 1) >> 1, ivec3(0)) >> height;
    ivec3 high = min(point >> 1, svo_nodes_in_use(0) - 1) >> height;
    for (int z = low.z; z <= high.z; z++)
        for (int y = low.y; y <= high.y; y++)
            for (int x = low.x; x <= high.x; x++) {
                uint at = svo_node(ivec3(x, y, z), push.depth);
                if (at != SVO_NONE) atomicOr(nodes[at], SVO_MARKED);
            }
}
