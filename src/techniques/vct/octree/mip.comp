// Bricks of a level from the bricks of their nodes' children (Hong 2015, sec. 2.5.3.3.3). An octant
// of a child's brick, 2 × 2 × 2 points, is reduced like 2 × 2 × 2 texels of a mip, and a point is
// the mean of its octants. Octants overlap in shared points, so that 3 × 3 × 3 points have the
// weights 1 2 1 along each axis: the paper's Gaussian. Anisotropic voxels composite the nearer
// point over the farther one along their direction, so that a thin wall keeps its opacity.
//
// A point on a side knows only the octants inside of the node: its half of the Gaussian, doubled.
// octree/join.comp adds the other half. Without a neighbour the value stays, so that no light is
// lost where the tree ends.
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

// An octant of a brick for a direction; `size` points along each axis lie in the grid.
vec4 octant(ivec3 from, int direction_index, ivec3 size)
{
    int axis = direction_index / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec3 at = ivec3(0);
        at[b] = i & 1;
        at[c] = i >> 1;
        if (any(greaterThanEqual(at, size))) continue;
        vec4 near = imageLoad(light, from + at);
        if (size[axis] == 2) {
            at[axis] = 1;
            vec4 far = imageLoad(light, from + at);
            if (!VCT_ANISOTROPIC)
                near = 0.5 * (near + far);
            else
                near = (direction_index & 1) == 0 ? vct_over(near, far) : vct_over(far, near);
        }
        sum += near;
    }
    return sum / float(size[b] * size[c]);
}

void main()
{
    uint i = gl_GlobalInvocationID.x / 32u, texel = gl_GlobalInvocationID.x % 32u;
    if (i >= levels[push.depth].count || texel >= 27u) return;
    uint brick = levels[push.depth].first + i;
    ivec3 point = ivec3(texel % 3u, texel / 3u % 3u, texel / 9u),
          node = svo_unpack(brick_coords[brick]);
    ivec3 last = svo_last_point(int(svo.depths - 2u - push.depth)); // of the children
    vec4 sum[6] = vec4[6](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    float octants = 0.0;
    for (int k = 0; k < 8; k++) {
        ivec3 choice = ivec3(k & 1, k >> 1 & 1, k >> 2), inner = point & 1;
        if (any(greaterThan(choice, inner))) continue;
        ivec3 child = mix(point >> 1, choice, equal(inner, ivec3(1)));
        ivec3 first =
            mix(point >> 1, 1 - choice, equal(inner, ivec3(1))); // point of the child's brick
        ivec3 at = 2 * node + child;
        if (any(greaterThanEqual(2 * at, last))) continue; // outside of the grid
        octants++;
        uint word = nodes[8u * (brick + 1u) + uint(child.x | child.y << 1 | child.z << 2)];
        if (word == 0u) continue;
        ivec3 from = svo_brick_texel(word - 1u) + first,
              size = min(last - (2 * at + first) + 1, ivec3(2));
        for (int direction_index = 0; direction_index < VCT_DIRECTIONS; direction_index++)
            sum[direction_index] +=
                octant(from + ivec3(3 * direction_index * svo.row, 0, 0), direction_index, size);
    }
    ivec3 to = svo_brick_texel(brick) + point;
    for (int direction_index = 0; direction_index < VCT_DIRECTIONS; direction_index++)
        imageStore(light, to + ivec3(3 * direction_index * svo.row, 0, 0),
                   sum[direction_index] / max(octants, 1.0));
}
