// Clears the sums of the voxels whose triangles are summed up.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/voxelize/voxelize_shared.h"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 0, scalar) readonly buffer vct_arguments
{
    vct_voxel_counts counts;
};
layout(set = 0, binding = 1, scalar) readonly buffer vct_accumulated_list
{
    uint accumulated_list[];
};
layout(set = 0, binding = 2, scalar) writeonly buffer vct_sum_words
{
    uint sums[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= counts.accumulated) return;
    uint at = accumulated_list[i] * VCT_SUM_WORDS;
    for (uint k = 0u; k < VCT_SUM_WORDS; k++) sums[at + k] = 0u;
}
