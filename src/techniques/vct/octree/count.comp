// Counts the marked nodes in each block of nodes at a depth.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/octree/octree_shared.h"

layout(local_size_x = VCT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_svo_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer vct_svo_nodes
{
    uint nodes[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer vct_svo_blocks
{
    uint blocks[];
};
#define VCT_SVO_LEVELS_BINDING 2
#define VCT_SVO_LEVELS_ACCESS  readonly
#include "techniques/vct/octree/levels.glsl"

void main()
{
    uint block = gl_GlobalInvocationID.x, nodes_here = svo_node_count(push.depth);
    if (block * VCT_SVO_BLOCK >= nodes_here) return;
    uint first = svo_first_node(push.depth) + block * VCT_SVO_BLOCK;
    uint end = min(first + VCT_SVO_BLOCK, svo_first_node(push.depth) + nodes_here), count = 0u;
    for (uint i = first; i < end; i++) count += nodes[i] >> 31;
    blocks[block] = count;
}
