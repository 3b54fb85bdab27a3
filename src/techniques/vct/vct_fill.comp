// The finest level of the light volume, from the lit voxels of both sets: 2 × 2 × 2 of them make a texel of six
// volumes, one for each way along an axis that light is looked for (anisotropic voxels: Crassin et al. 2011; Hong
// 2015, sec. 2.5.3.3.10). vct_seen.glsl says what voxels show and hide.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/vct_seen.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 7, rgba16f) uniform writeonly image3D light;

// Whether any of 2 × 2 × 2 voxels holds a surface. A texel's two voxels along x share a word.
bool occupied(ivec3 texel)
{
    uint any = 0u;
    for (int i = 0; i < 4; i++) {
        uint index = vct_index(2 * texel + ivec3(0, i & 1, i >> 1));
        any |= ((static_mask_words[index >> 5] | dynamic_mask_words[index >> 5]) >> (index & 31u)) & 3u;
    }
    return any != 0u;
}

void main()
{
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(2 * texel, vct_cells()))) return;
    vec4 sum[6] = vec4[6](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    if (occupied(texel)) vct_see(2 * texel, ivec3(2), sum);
    for (int k = 0; k < VCT_WAYS; k++)
        imageStore(light, texel + ivec3(k * vct.volume_dim, 0, 0), min(sum[k], vec4(HALF_MAX)));
}
