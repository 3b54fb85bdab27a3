// Makes the points that two neighbours share equal in both bricks (Hong 2015, sec. 2.5.3.3.9,
// figure 48, in two passes per axis; here the lower node writes both). One dispatch per axis.
//
// Each brick holds half of the point. Leaves: the voxels on either side; voxels behind each other
// are composited front to back, adjacent ones averaged. Above: each holds twice its half of the
// Gaussian, so that the mean of both is the whole.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/octree/octree_shared.h"
#include "techniques/vct/volume/over.glsl"
#include "techniques/vct/volume/directions.glsl"

layout(local_size_x = VCT_SVO_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_svo_push push;
};
layout(set = 0, binding = 1, rgba16f) uniform image3D light;
layout(set = 0, binding = 2, scalar) readonly buffer vct_svo_nodes
{
    uint nodes[];
};
layout(set = 0, binding = 3, scalar) readonly buffer vct_svo_brick_coords
{
    uint brick_coords[];
};
#define VCT_SVO_LEVELS_BINDING 4
#define VCT_SVO_LEVELS_ACCESS  readonly
#include "techniques/vct/octree/levels.glsl"
#include "techniques/vct/octree/octree.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x / 16u, texel = gl_GlobalInvocationID.x % 16u;
    if (i >= levels[push.depth].count || texel >= 9u) return;
    uint brick = levels[push.depth].first + i;
    int axis = int(push.axis);
    ivec3 next = svo_unpack(brick_coords[brick]);
    next[axis]++;
    bool leaf = push.depth + 1u == svo.depths;
    if (next[axis] >= svo_nodes_in_use(int(svo.depths - 1u - push.depth))[axis]) return;
    uint other = svo_find(next, push.depth);
    if (other == SVO_NONE) return;
    ivec3 point = ivec3(0);
    point[(axis + 1) % 3] = int(texel % 3u);
    point[(axis + 2) % 3] = int(texel / 3u);
    ivec3 there = svo_brick_texel(other) + point;
    point[axis] = 2;
    ivec3 here = svo_brick_texel(brick) + point;
    for (int direction_index = 0; direction_index < VCT_DIRECTIONS; direction_index++) {
        ivec3 side = ivec3(3 * direction_index * svo.row, 0, 0);
        vec4 low = imageLoad(light, here + side), high = imageLoad(light, there + side),
             joined = 0.5 * (low + high);
        if (VCT_ANISOTROPIC && leaf && direction_index / 2 == axis)
            joined = (direction_index & 1) == 0 ? vct_over(low, high) : vct_over(high, low);
        imageStore(light, here + side, joined);
        imageStore(light, there + side, joined);
    }
}
