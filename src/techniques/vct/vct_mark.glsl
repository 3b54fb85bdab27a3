// First walk: a bit for each voxel that a triangle touches. Define VCT_LARGE.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/vct_voxelise.glsl"

layout(set = 0, binding = 16, scalar) buffer vct_mask { uint mask[]; };

void vct_visit(ivec3 voxel, vct_triangle t)
{
    uint index = vct_index(voxel);
    atomicOr(mask[index >> 5], 1u << (index & 31u));
}
