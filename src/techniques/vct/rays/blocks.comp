// Occupied faces of each block of 2 × 2 × 2 voxels in one texel, for rays: see rays/rays_shared.h.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/rays/plane.glsl"
#include "techniques/vct/rays/rays_shared.h"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/vct_voxel_images.glsl"
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
layout(set = 0, binding = 3, scalar) readonly buffer vct_texel_mask
{
    uint entered[];
};
layout(set = 0, binding = 4, rgba32ui) uniform writeonly uimage3D vct_blocks;
layout(set = 0, binding = 5, scalar) readonly buffer static_word_offsets
{
    uint static_offsets[];
};
layout(set = 0, binding = 6, scalar) readonly buffer dynamic_word_offsets
{
    uint dynamic_offsets[];
};
layout(set = 0, binding = 9, r32ui) uniform writeonly uimage3D static_first_slots;
layout(set = 0, binding = 10, r32ui) uniform writeonly uimage3D dynamic_first_slots;
layout(set = 0, binding = 7) uniform usampler2D static_planes;
layout(set = 0, binding = 8) uniform usampler2D dynamic_planes;

// The largest mip whose texel around an empty texel is empty too.
uint empty_level(ivec3 texel)
{
    uint level = 0u;
    while (level + 1u < push.levels) {
        texel >>= 1;
        uint dim = uint(vct.volume_dim) >> (level + 1u);
        uint index = push.mask_first[level + 1u] + (uint(texel.z) * dim + uint(texel.y)) * dim +
                     uint(texel.x);
        if ((entered[index >> 5] >> (index & 31u) & 1u) != 0u) break;
        level++;
    }
    return level;
}

// A word of a mask with a bit for voxels whose surfaces lie along the axes.
uint with_alignment(uint word, uint slot, usampler2D planes)
{
    uint others = 0u; // voxels with other surfaces
    for (uint rest = word; rest != 0u && slot < vct.capacity; rest &= rest - 1u, slot++) {
        vct_plane plane =
            vct_unpack_plane(texelFetch(planes, vct_face_texel(vct.face_first + slot), 0).rg);
        if (!vct_plane_aligned(plane.normal)) others |= 1u << (uint(findLSB(rest)) & 24u);
    }
    return word | (VCT_EACH_VOXEL - others) << 6;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (2u * i >= static_mask_words.length()) return;
    ivec3 texel = vct_texel(i);
    uvec4 faces = uvec4(static_mask_words[2u * i], static_mask_words[2u * i + 1u],
                        dynamic_mask_words[2u * i], dynamic_mask_words[2u * i + 1u]);
    ivec3 to = texel + ivec3(0, 0, vct.volume_first);
    if (faces == uvec4(0u)) {
        faces.x = VCT_BLOCK_EMPTY | empty_level(texel);
    } else {
        imageStore(static_first_slots, to, uvec4(vct.face_first + static_offsets[2u * i]));
        imageStore(dynamic_first_slots, to, uvec4(vct.face_first + dynamic_offsets[2u * i]));
        faces.x = with_alignment(faces.x, static_offsets[2u * i], static_planes);
        faces.y = with_alignment(faces.y, static_offsets[2u * i + 1u], static_planes);
        faces.z = with_alignment(faces.z, dynamic_offsets[2u * i], dynamic_planes);
        faces.w = with_alignment(faces.w, dynamic_offsets[2u * i + 1u], dynamic_planes);
    }
    imageStore(vct_blocks, to, faces);
}
