// Counts the occupied voxels in each block of words.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/voxelize/voxelize_shared.h"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 0, scalar) readonly buffer vct_mask
{
    uint mask[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer vct_blocks
{
    uint blocks[];
};

void main()
{
    uint block = gl_GlobalInvocationID.x;
    if (block >= blocks.length()) return;
    uint first = block * VCT_BLOCK_WORDS, end = min(first + VCT_BLOCK_WORDS, mask.length());
    uint count = 0u;
    for (uint i = first; i < end; i++) count += bitCount(mask[i]);
    blocks[block] = count;
}
