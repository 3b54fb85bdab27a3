// From the voxels in each block to the voxels before it, by one workgroup; and how many groups shade them.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_grid.glsl"

layout(local_size_x = VCT_SCAN_LOCAL) in;

layout(set = 0, binding = 0, scalar) buffer vct_blocks { uint blocks[]; };
// x, y, z of a dispatch over the voxels; how many there are; how many have no room.
layout(set = 0, binding = 1, scalar) writeonly buffer vct_arguments { uint groups[3]; uint listed; uint left_out; };

shared uint before[VCT_SCAN_LOCAL];

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint count = blocks.length();
    uint each = (count + VCT_SCAN_LOCAL - 1u) / VCT_SCAN_LOCAL;
    uint first = min(me * each, count), end = min(first + each, count);
    uint sum = 0u;
    for (uint i = first; i < end; i++) sum += blocks[i];
    before[me] = sum;
    barrier();
    for (uint step = 1u; step < VCT_SCAN_LOCAL; step *= 2u) {
        uint add = me >= step ? before[me - step] : 0u;
        barrier();
        before[me] += add;
        barrier();
    }
    uint running = before[me] - sum;
    for (uint i = first; i < end; i++) {
        uint here = blocks[i];
        blocks[i] = running;
        running += here;
    }
    if (me == VCT_SCAN_LOCAL - 1u) {
        listed = min(running, vct.capacity);
        left_out = running - min(running, vct.capacity);
        groups[0] = (min(running, vct.capacity) + VCT_LOCAL - 1u) / VCT_LOCAL;
        groups[1] = 1u;
        groups[2] = 1u;
    }
}
