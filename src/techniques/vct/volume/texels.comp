// Lists the occupied texels of the light volume, for each mip. The first child that arrives enters
// its coarser texel. Results do not depend on the order of a list.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/volume/volume_shared.h"

layout(local_size_x = VCT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    vct_texels_push push;
};
layout(set = 0, binding = 1, scalar) readonly buffer static_mask
{
    uint static_mask_words[];
};
layout(set = 0, binding = 2, scalar) readonly buffer dynamic_mask
{
    uint dynamic_mask_words[];
};
layout(set = 0, binding = 3, scalar) buffer vct_texel_mask
{
    uint entered[];
};
layout(set = 0, binding = 4, scalar) writeonly buffer vct_texels
{
    uint texels[];
};
layout(set = 0, binding = 5, scalar) buffer vct_texel_counts
{
    vct_texel_levels state;
};

void enter(uint level, uint place, ivec3 texel)
{
    texels[push.first[level] + place] = vct_pack_texel(texel);
    uint each = level == 0u ? 1u : push.directions; // invocations per texel: see mip.comp
    atomicMax(state.groups[3u * level], ((place + 1u) * each + VCT_LOCAL - 1u) / VCT_LOCAL);
    if (level == push.block_level)
        atomicMax(state.block_groups[0], VCT_FACES * (place / VCT_BLOCK_LOCAL + 1u));
}

void enter_parents(ivec3 texel)
{
    for (uint level = 1u; level < push.levels; level++) {
        texel >>= 1;
        uint dim = uint(vct.volume_dim) >> level;
        uint index =
            push.mask_first[level] + (uint(texel.z) * dim + uint(texel.y)) * dim + uint(texel.x);
        uint bit = 1u << (index & 31u);
        if ((atomicOr(entered[index >> 5], bit) & bit) != 0u) return;
        enter(level, atomicAdd(state.count[level], 1u), texel);
    }
}

void main()
{
    uint first = VCT_TEXELS_EACH * gl_GlobalInvocationID.x, any = 0u;
    if (2u * first >= static_mask_words.length()) return;
    for (uint i = 0u; i < VCT_TEXELS_EACH; i++) {
        uint word = 2u * (first + i);
        uint faces = static_mask_words[word] | static_mask_words[word + 1u] |
                     dynamic_mask_words[word] | dynamic_mask_words[word + 1u];
        any |= faces != 0u ? 1u << i : 0u;
    }
    if (any == 0u) return;
    uint place = atomicAdd(state.count[0], uint(bitCount(any)));
    for (; any != 0u; any &= any - 1u, place++) {
        ivec3 texel = vct_texel(first + uint(findLSB(any)));
        enter(0u, place, texel);
        enter_parents(texel);
    }
}
