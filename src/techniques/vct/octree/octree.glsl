// The sparse voxel octree: nodes by pointers, bricks of light in a pool (Crassin et al. 2011; Hong
// 2015, sec. 2.5.3.2). Include after vct_grid.glsl; declare vct_svo_nodes with `nodes` before.
//
// Sample points are two voxels apart, like texels of the finest mip, but on the corners of nodes:
// point q covers the voxels 2q − 1 and 2q along each axis. A leaf is two point spacings wide, and a
// node's brick holds the 3³ points in and on it, so that interpolation stays within one brick.
// Nodes of a level, and their point spacing, are twice as wide as those of the level below.
//
// Nodes are allocated in tiles of eight. An empty node is 0; others are 1 + the index of their
// brick, which is also the index of their children's tile: both are allocated together. The root is
// node 0, alone in its tile.
#ifndef AG_VCT_SVO_GLSL
#define AG_VCT_SVO_GLSL

#include "techniques/vct/octree/octree_shared.h"

layout(set = 0, binding = 20, scalar) uniform vct_svo
{
    vct_svo_params svo;
};

const uint SVO_MARKED = 0x80000000u; // bit of a node: subdivide it
const uint SVO_NONE = 0xffffffffu;

uint svo_pack(ivec3 node)
{
    return uint(node.x | node.y << 10 | node.z << 20);
}

ivec3 svo_unpack(uint packed)
{
    return ivec3(packed & 1023u, packed >> 10 & 1023u, packed >> 20);
}

// Last point in the grid at a height above the leaves (0: the leaves).
ivec3 svo_last_point(int height)
{
    return (vct_cells() / 2 + (1 << height) - 1) >> height;
}

// Nodes along each axis that overlap the grid.
ivec3 svo_nodes_in_use(int height)
{
    return ((vct_cells() / 2 + 1) / 2 + (1 << height) - 1) >> height;
}

// First texel of a brick. Bricks of the next direction are 3 · row texels further along x.
ivec3 svo_brick_texel(uint brick)
{
    int i = int(brick), row = svo.row;
    return 3 * ivec3(i % row, i / row % row, i / (row * row));
}

// Index of a node at a depth, or SVO_NONE where an ancestor is empty.
uint svo_node(ivec3 node, uint depth)
{
    uint at = 0u;
    for (uint left = depth; left > 0u; left--) {
        uint word = nodes[at];
        if (word == 0u) return SVO_NONE;
        ivec3 child = node >> int(left - 1u) & 1;
        at = 8u * word + uint(child.x | child.y << 1 | child.z << 2);
    }
    return at;
}

// Brick of a node, or SVO_NONE.
uint svo_find(ivec3 node, uint depth)
{
    uint at = svo_node(node, depth);
    return at == SVO_NONE || nodes[at] == 0u ? SVO_NONE : nodes[at] - 1u;
}

#endif
