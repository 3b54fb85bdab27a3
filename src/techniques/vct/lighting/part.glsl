// A part: faces of one block of voxels that lie on one surface. Packed into an RGBA32U texel.
#ifndef AG_VCT_PART_GLSL
#define AG_VCT_PART_GLSL

#include "techniques/vct/lighting/lighting_shared.h"
#include "techniques/vct/vct_voxel_images.glsl"

struct vct_part_record {
    vec3 position; // in voxels of the grid
    vec3 normal;
    uint number; // of the part: for its points in the strata
    uint turn;   // the block's place in the order of turns; 16 bits
};

const float VCT_PART_FIXED = 128.0; // units per voxel

uvec4 vct_pack_part(vct_part_record r)
{
    uvec3 at = uvec3(clamp(roundEven(r.position * VCT_PART_FIXED), 0.0, 65535.0));
    return uvec4(at.x | at.y << 16, at.z | r.turn << 16, r.number, vct_pack_normal(r.normal));
}

uint vct_part_turn(uvec4 packed)
{
    return packed.y >> 16;
}

vct_part_record vct_unpack_part(uvec4 packed)
{
    uvec3 at = uvec3(packed.x & 0xffffu, packed.x >> 16, packed.y & 0xffffu);
    return vct_part_record(vec3(at) / VCT_PART_FIXED, vct_unpack_normal(packed.w), packed.z,
                           vct_part_turn(packed));
}

#endif
