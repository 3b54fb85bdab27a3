// The list of occupied voxels, in the order of their numbers; and the voxels before each word.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_grid.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 0, scalar) readonly buffer vct_mask { uint mask[]; };
layout(set = 0, binding = 1, scalar) readonly buffer vct_blocks { uint blocks[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer vct_before { uint before[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer vct_list { uint list[]; };

void main()
{
    uint block = gl_GlobalInvocationID.x;
    if (block >= blocks.length()) return;
    uint first = block * VCT_BLOCK_WORDS, end = min(first + VCT_BLOCK_WORDS, mask.length());
    uint slot = blocks[block];
    for (uint i = first; i < end; i++) {
        before[i] = slot;
        for (uint bits = mask[i]; bits != 0u; bits &= bits - 1u, slot++) {
            if (slot >= vct.capacity) continue;
            list[slot] = i * 32u + uint(findLSB(bits));
        }
    }
}
