// Images with one row-major entry, its slot, per occupied face: addresses, and packed normals.
// Software drivers fetch texels several times as fast as words of buffers.
#ifndef AG_VCT_VOXEL_IMAGES_GLSL
#define AG_VCT_VOXEL_IMAGES_GLSL

#include "frame/octahedral.glsl"

// First of the two texels of a surface.
ivec2 vct_surface_texel(uint slot)
{
    return ivec2(2u * (slot % VCT_VOXEL_ROW), slot / VCT_VOXEL_ROW);
}

// Texel with what takes one for each face: its light, or the irradiance on it.
ivec2 vct_face_texel(uint slot)
{
    return ivec2(slot % VCT_VOXEL_ROW, slot / VCT_VOXEL_ROW);
}

// 12 + 12 bits. Even, so that normals along axes stay exact.
uint vct_pack_normal(vec3 normal)
{
    uvec2 code = uvec2(roundEven((octahedral_encode(normal) * 0.5 + 0.5) * 4094.0));
    return code.x | code.y << 12;
}

vec3 vct_unpack_normal(uint bits)
{
    return octahedral_decode(vec2(bits & 4095u, bits >> 12) / 4094.0 * 2.0 - 1.0);
}

#endif
