// Fills mip 0 of the light volume from the lit voxels of both sets. 2 × 2 × 2 voxels make a texel
// of each of the six directional volumes (anisotropic voxels: Crassin et al. 2011; Hong 2015, sec.
// 2.5.3.3.10), prefiltered by volume/prefilter.glsl. Texels without a voxel are not in the list and
// stay 0.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/volume/volume_shared.h"
#include "techniques/vct/volume/prefilter.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 7) uniform writeonly image3D light;
layout(set = 0, binding = 8, scalar) readonly buffer vct_texels
{
    uint texels[];
};
layout(set = 0, binding = 9, scalar) readonly buffer vct_texel_counts
{
    vct_texel_levels state;
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= state.count[0]) return;
    ivec3 texel = vct_unpack_texel(texels[i]);
    vec4 sum[6];
    vct_prefilter_block(2 * texel, ivec3(2), sum);
    for (int k = 0; k < VCT_DIRECTIONS; k++) {
        vec4 value = min(sum[k], vec4(HALF_MAX));
        if (VCT_OCCLUSION) value = value.aaaa;
        imageStore(light, texel + ivec3(k * vct.volume_dim, 0, vct.volume_first), value);
    }
}
