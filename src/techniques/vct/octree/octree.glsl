// The sparse voxel octree: nodes by pointers, bricks of light in a pool (Crassin et al. 2011; Hong
// 2015, sec. 2.5.3.2). Include after vct_grid.glsl; declare vct_svo_nodes with `nodes` before.
//
// Points stand two voxels apart, as texels of the finest mip do, but on the corners of nodes: point
// q has the voxels 2q − 1 and 2q along each axis. A leaf is two distances of points wide, and a
// node's brick has the 3³ points in and on it, so that what lies between points is filtered within
// one brick. Nodes of a level are twice as wide as those below, and so are the distances of their
// points.
//
// Nodes come in tiles of eight. A node is 0 where it is empty; else it is 1 + the number of its
// brick, which also is the tile of its children: both are given out together. The root is node 0,
// alone in its tile.
#ifndef AG_VCT_SVO_GLSL
#define AG_VCT_SVO_GLSL

#include "techniques/vct/octree/octree_shared.h"

layout(set = 0, binding = 20, scalar) uniform vct_svo
{
    vct_svo_params svo;
};

const uint SVO_MARKED = 0x80000000u; // of a node: to be divided
const uint SVO_NONE = 0xffffffffu;

uint svo_pack(ivec3 node)
{
    return uint(node.x | node.y << 10 | node.z << 20);
}

ivec3 svo_unpack(uint packed)
{
    return ivec3(packed & 1023u, packed >> 10 & 1023u, packed >> 20);
}

// Points in use at a height over the leaves, 0: theirs. What lies beyond the last one is outside of
// the grid.
ivec3 svo_last_point(int height)
{
    return (vct_cells() / 2 + (1 << height) - 1) >> height;
}

// Nodes along the axes that have a part of the grid.
ivec3 svo_nodes_in_use(int height)
{
    return ((vct_cells() / 2 + 1) / 2 + (1 << height) - 1) >> height;
}

// The first texel of a brick. Bricks of another way are 3 · row texels further along x.
ivec3 svo_brick_texel(uint brick)
{
    int i = int(brick), row = svo.row;
    return 3 * ivec3(i % row, i / row % row, i / (row * row));
}

// The place of a node at a depth in the pool, or SVO_NONE where a node above it is empty.
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

// Its brick, or SVO_NONE.
uint svo_find(ivec3 node, uint depth)
{
    uint at = svo_node(node, depth);
    return at == SVO_NONE || nodes[at] == 0u ? SVO_NONE : nodes[at] - 1u;
}

#endif
