// Light of the voxels in each leaf to the points of its brick. An inner point covers 2 × 2 × 2
// voxels, like a texel of the finest mip; a point on a side gets half of its voxels here and the
// other half in the neighbour (octree/join.comp).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/octree/octree_shared.h"
#include "techniques/vct/volume/prefilter.glsl"

layout(local_size_x = VCT_SVO_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_svo_push push;
};
layout(set = 0, binding = 7, rgba16f) uniform writeonly image3D light;
layout(set = 0, binding = 8, scalar) readonly buffer vct_svo_nodes
{
    uint nodes[];
};
layout(set = 0, binding = 9, scalar) readonly buffer vct_svo_brick_coords
{
    uint brick_coords[];
};
#define VCT_SVO_LEVELS_BINDING 10
#define VCT_SVO_LEVELS_ACCESS  readonly
#include "techniques/vct/octree/levels.glsl"
#include "techniques/vct/octree/octree.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x / 32u, texel = gl_GlobalInvocationID.x % 32u;
    if (i >= levels[push.depth].count || texel >= 27u) return;
    uint brick = levels[push.depth].first + i;
    ivec3 point = ivec3(texel % 3u, texel / 3u % 3u, texel / 9u);
    // The points cover the first, the middle two and the last of the four voxels across a leaf.
    ivec3 from = 4 * svo_unpack(brick_coords[brick]) + point + (point >> 1);
    ivec3 size = min(1 + (point & 1), vct_cells() - from);
    vec4 sum[6] = vec4[6](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (all(greaterThan(size, ivec3(0)))) vct_prefilter_block(from, size, sum);
    ivec3 to = svo_brick_texel(brick) + point;
    for (int k = 0; k < VCT_DIRECTIONS; k++)
        imageStore(light, to + ivec3(3 * k * svo.row, 0, 0), min(sum[k], vec4(HALF_MAX)));
}
