// Images with one row-major entry, its slot, per occupied voxel: addresses, and packed normals.
// Software drivers fetch texels several times as fast as words of buffers.
#ifndef AG_VCT_VOXEL_IMAGES_GLSL
#define AG_VCT_VOXEL_IMAGES_GLSL

#include "frame/octahedral.glsl"

// First of the two texels of a surface or a lit voxel.
ivec2 vct_voxel_texel(uint slot)
{
    return ivec2(2u * (slot % VCT_VOXEL_ROW), slot / VCT_VOXEL_ROW);
}

// Texel with the irradiance on the front and the back, six half floats.
ivec2 vct_bounced_texel(uint slot)
{
    return ivec2(slot % VCT_VOXEL_ROW, slot / VCT_VOXEL_ROW);
}

// 12 + 12 bits. Front normals lie in one half of the sphere (voxelize/add.glsl) that contains no
// direction of code 0.
uint vct_pack_normal(vec3 normal)
{
    uvec2 code = uvec2(roundEven((octahedral_encode(normal) * 0.5 + 0.5) * 4095.0));
    return normal == vec3(0.0) ? 0u : code.x | code.y << 12;
}

vec3 vct_unpack_normal(uint bits)
{
    return bits == 0u ? vec3(0.0)
                      : octahedral_decode(vec2(bits & 4095u, bits >> 12) / 4095.0 * 2.0 - 1.0);
}

#endif
