// What a lit voxel is, as 8 words: what its two sides send out, and what light on them would add.
// Half floats and bytes, in two texels of an image that is filled row by row: software drivers
// fetch texels several times as fast as words of buffers.
#ifndef AG_VCT_LIT_VOXEL_GLSL
#define AG_VCT_LIT_VOXEL_GLSL

#include "techniques/vct/vct_voxel_images.glsl"

struct vct_lit_voxel {
    vec3 front, back;                 // scaled cd/m²: reflected light of lights
    vec3 emitted_front, emitted_back; // scaled cd/m²; negative: a lamp's
    vec3 reflectance;
    vec2 opacity; // to ways that meet the front, the back
    vec3 normal;  // unit, of the front; 0 where the sides cannot be told apart
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

// What of it is seen, with or without lamps.
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
