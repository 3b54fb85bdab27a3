// Exclusive prefix sum of the marked nodes in each block, by one workgroup. Allocates bricks,
// counts the overflow and writes the group counts of indirect dispatches.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/octree/octree_shared.h"

layout(local_size_x = VCT_SCAN_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_svo_push push;
};
layout(set = 0, binding = 1, scalar) readonly buffer vct_svo_nodes
{
    uint nodes[];
};
layout(set = 0, binding = 2, scalar) buffer vct_svo_blocks
{
    uint blocks[];
};
#define VCT_SVO_LEVELS_BINDING 3
#define VCT_SVO_LEVELS_ACCESS
#include "techniques/vct/octree/levels.glsl"
#include "techniques/vct/octree/octree.glsl"

shared uint before[VCT_SCAN_LOCAL];

uint groups_of(uint count, uint local)
{
    return max((count + local - 1u) / local, 1u);
}

void main()
{
    uint lane = gl_LocalInvocationID.x;
    uint count = (svo_node_count(push.depth) + VCT_SVO_BLOCK - 1u) / VCT_SVO_BLOCK;
    uint each = (count + VCT_SCAN_LOCAL - 1u) / VCT_SCAN_LOCAL;
    uint first = min(lane * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++) sum += blocks[i];
    before[lane] = sum;
    barrier();
    for (uint step = 1u; step < VCT_SCAN_LOCAL; step *= 2u) {
        uint add = lane >= step ? before[lane - step] : 0u;
        barrier();
        before[lane] += add;
        barrier();
    }
    uint running = before[lane] - sum;
    for (uint i = first; i < end; i++) {
        uint here = blocks[i];
        blocks[i] = running;
        running += here;
    }
    if (lane != VCT_SCAN_LOCAL - 1u) return;
    uint taken =
        push.depth == 0u ? 0u : levels[push.depth - 1u].first + levels[push.depth - 1u].count;
    // Inner nodes also need a tile for their children.
    uint capacity = push.depth + 1u < svo.depths ? min(svo.bricks, svo.tiles) : svo.bricks;
    uint allocated = min(running, capacity - min(taken, capacity));
    levels[push.depth].first = taken;
    levels[push.depth].count = allocated;
    levels[push.depth].overflow = running - allocated;
    levels[push.depth].node_groups[0] = groups_of(8u * allocated, VCT_SVO_BLOCK * VCT_LOCAL);
    levels[push.depth].texel_groups[0] = groups_of(allocated, VCT_SVO_LOCAL / 32u);
    levels[push.depth].side_groups[0] = groups_of(allocated, VCT_SVO_LOCAL / 16u);
    for (int k = 1; k < 3; k++)
        levels[push.depth].node_groups[k] = levels[push.depth].texel_groups[k] =
            levels[push.depth].side_groups[k] = 1u;
}
