// Prefix sum over the occupied voxels of the blocks, by one workgroup, and the dispatch over all
// occupied voxels.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/voxelize/voxelize_shared.h"

layout(local_size_x = VCT_SCAN_LOCAL) in;

layout(set = 0, binding = 0, scalar) buffer vct_blocks
{
    uint blocks[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer vct_arguments
{
    vct_voxel_counts counts;
};

shared uint sums[VCT_SCAN_LOCAL];

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint count = blocks.length();
    uint each = (count + VCT_SCAN_LOCAL - 1u) / VCT_SCAN_LOCAL;
    uint first = min(me * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++) sum += blocks[i];
    sums[me] = sum;
    barrier();
    for (uint step = 1u; step < VCT_SCAN_LOCAL; step *= 2u) {
        uint add = me >= step ? sums[me - step] : 0u;
        barrier();
        sums[me] += add;
        barrier();
    }
    uint running = sums[me] - sum;
    for (uint i = first; i < end; i++) {
        uint here = blocks[i];
        blocks[i] = running;
        running += here;
    }
    if (me == VCT_SCAN_LOCAL - 1u) {
        uint listed = min(running, vct.capacity);
        counts.listed = listed;
        counts.overflow = running - listed;
        counts.accumulated = 0u; // list.comp counts them
        counts.groups[0] = (listed + VCT_LOCAL - 1u) / VCT_LOCAL;
        counts.accumulated_groups[0] = 1u;
        for (int i = 1; i < 3; i++) counts.groups[i] = counts.accumulated_groups[i] = 1u;
    }
}
