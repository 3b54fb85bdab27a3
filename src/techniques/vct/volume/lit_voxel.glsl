// Lit voxels: reflected and emitted radiance of both sides, packed into two RGBA32U texels.
#ifndef AG_VCT_LIT_VOXEL_GLSL
#define AG_VCT_LIT_VOXEL_GLSL

#include "techniques/vct/vct_voxel_images.glsl"

struct vct_lit_voxel {
    vec3 front, back;                 // scaled cd/m²: reflected radiance
    vec3 emitted_front, emitted_back; // scaled cd/m²; negative for small emitters
    vec3 reflectance;
    vec2 opacity; // seen from the front, from the back
    vec3 normal;  // unit, of the front; 0 where the sides are ambiguous
};

void vct_pack(vct_lit_voxel r, out uvec4 first, out uvec4 second)
{
    first = uvec4(packHalf2x16(r.front.rg), packHalf2x16(vec2(r.front.b, r.back.r)),
                  packHalf2x16(r.back.gb), packHalf2x16(r.emitted_front.rg));
    second.x = packHalf2x16(vec2(r.emitted_front.b, r.emitted_back.r));
    second.y = packHalf2x16(r.emitted_back.gb);
    second.z = packUnorm4x8(vec4(r.reflectance, r.opacity.x));
    second.w = vct_pack_normal(r.normal) | uint(roundEven(r.opacity.y * 255.0)) << 24;
}

vct_lit_voxel vct_unpack(uvec4 first, uvec4 second)
{
    vec2 a = unpackHalf2x16(first.y), b = unpackHalf2x16(second.x);
    vec4 c = unpackUnorm4x8(second.z);
    vct_lit_voxel r;
    r.front = vec3(unpackHalf2x16(first.x), a.x);
    r.back = vec3(a.y, unpackHalf2x16(first.z));
    r.emitted_front = vec3(unpackHalf2x16(first.w), b.x);
    r.emitted_back = vec3(b.y, unpackHalf2x16(second.y));
    r.reflectance = c.rgb;
    r.opacity = vec2(c.a, float(second.w >> 24) / 255.0);
    r.normal = vct_unpack_normal(second.w & 0xffffffu);
    return r;
}

// Emitted radiance, with or without small emitters.
vec3 vct_emitted(vec3 emitted, bool small_emitters)
{
    return small_emitters ? abs(emitted) : max(emitted, vec3(0.0));
}

vct_lit_voxel vct_lit_voxel_at(usampler2D records, uint slot)
{
    ivec2 place = vct_voxel_texel(slot);
    return vct_unpack(texelFetch(records, place, 0), texelFetch(records, place + ivec2(1, 0), 0));
}

#endif
