// Subdivides marked nodes: each gets a brick, in node order, and above the leaves eight empty
// children. Nodes beyond the capacity become empty.
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
layout(set = 0, binding = 1, scalar) buffer vct_svo_nodes
{
    uint nodes[];
};
layout(set = 0, binding = 2, scalar) readonly buffer vct_svo_blocks
{
    uint blocks[];
};
layout(set = 0, binding = 3, scalar) buffer vct_svo_brick_coords
{
    uint brick_coords[]; // of the brick's node
};
#define VCT_SVO_LEVELS_BINDING 4
#define VCT_SVO_LEVELS_ACCESS  readonly
#include "techniques/vct/octree/levels.glsl"
#include "techniques/vct/octree/octree.glsl"

ivec3 coord_of(uint node)
{
    uint tile = node / 8u;
    ivec3 child = ivec3(node & 1u, node >> 1 & 1u, node >> 2 & 1u);
    return tile == 0u ? child : 2 * svo_unpack(brick_coords[tile - 1u]) + child;
}

void main()
{
    uint block = gl_GlobalInvocationID.x, nodes_here = svo_node_count(push.depth);
    if (block * VCT_SVO_BLOCK >= nodes_here) return;
    uint first = svo_first_node(push.depth) + block * VCT_SVO_BLOCK;
    uint end = min(first + VCT_SVO_BLOCK, svo_first_node(push.depth) + nodes_here);
    uint rank = blocks[block];
    for (uint i = first; i < end; i++) {
        if ((nodes[i] & SVO_MARKED) == 0u) continue;
        bool fits = rank < levels[push.depth].count;
        uint brick = levels[push.depth].first + rank;
        rank++;
        nodes[i] = fits ? brick + 1u : 0u;
        if (!fits) continue;
        brick_coords[brick] = svo_pack(coord_of(i));
        if (push.depth + 1u == svo.depths) continue;
        for (uint child = 0u; child < 8u; child++) nodes[8u * (brick + 1u) + child] = 0u;
    }
}
