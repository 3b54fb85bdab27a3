// First pass: marks each voxel that a triangle touches. A second bit marks the voxels that have
// more than a single large triangle: their attributes are summed up.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/voxelize/voxelize.glsl"

layout(set = 0, binding = 16, scalar) buffer vct_mask
{
    uint mask[];
};
layout(set = 0, binding = 17, scalar) buffer vct_accumulated
{
    uint accumulated[];
};

void vct_begin_triangle(vct_triangle t, ivec2 first)
{
}

void vct_visit(ivec3 voxel, vct_triangle t)
{
    uint index = vct_index(voxel), word = index >> 5, bit = 1u << (index & 31u);
    bool touched = (atomicOr(mask[word], bit) & bit) != 0u;
#if defined(VCT_RASTER) || !VCT_LARGE
    touched = true;
#endif
    if (touched) atomicOr(accumulated[word], bit);
}
