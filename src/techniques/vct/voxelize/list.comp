// Lists the occupied voxels by index, with the number of voxels before each word, and in any order
// the slots of the voxels whose triangles are summed up.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/voxelize/voxelize_shared.h"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 0, scalar) readonly buffer vct_mask
{
    uint mask[];
};
layout(set = 0, binding = 1, scalar) readonly buffer vct_blocks
{
    uint blocks[];
};
layout(set = 0, binding = 2, scalar) writeonly buffer vct_word_offsets
{
    uint offsets[];
};
layout(set = 0, binding = 3, scalar) writeonly buffer vct_list
{
    uint list[];
};
layout(set = 0, binding = 4, scalar) readonly buffer vct_accumulated
{
    uint accumulated[];
};
layout(set = 0, binding = 5, scalar) writeonly buffer vct_accumulated_list
{
    uint accumulated_list[];
};
layout(set = 0, binding = 6, scalar) buffer vct_arguments
{
    vct_voxel_counts counts;
};

// The first bits of a word whose slots are within the capacity.
uint within_capacity(uint word, uint slot)
{
    uint free_slots = vct.capacity - min(slot, vct.capacity);
    while (uint(bitCount(word)) > free_slots) word &= ~(1u << uint(findMSB(word)));
    return word;
}

void main()
{
    uint block = gl_GlobalInvocationID.x;
    if (block >= blocks.length()) return;
    uint first = block * VCT_BLOCK_WORDS, end = min(first + VCT_BLOCK_WORDS, mask.length());
    uint slot = blocks[block], accumulated_count = 0u;
    for (uint i = first; i < end; i++) {
        offsets[i] = slot;
        uint word = within_capacity(mask[i], slot);
        accumulated_count += uint(bitCount(accumulated[i] & word));
        for (; word != 0u; word &= word - 1u, slot++) list[slot] = i * 32u + uint(findLSB(word));
    }
    if (accumulated_count == 0u) return;
    uint to = atomicAdd(counts.accumulated, accumulated_count);
    atomicMax(counts.accumulated_groups[0], (to + accumulated_count + VCT_LOCAL - 1u) / VCT_LOCAL);
    slot = blocks[block];
    for (uint i = first; i < end; i++) {
        uint word = within_capacity(mask[i], slot);
        for (uint bits = accumulated[i] & word; bits != 0u; bits &= bits - 1u, to++)
            accumulated_list[to] = slot + uint(bitCount(word & ((bits & -bits) - 1u)));
        slot += uint(bitCount(word));
    }
}
