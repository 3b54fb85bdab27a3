// Light of a voxel's face: reflected and emitted radiance, packed into an RGBA32U texel.
#ifndef AG_VCT_LIT_FACE_GLSL
#define AG_VCT_LIT_FACE_GLSL

#include "techniques/vct/vct_voxel_images.glsl"

struct vct_lit_face {
    vec3 reflected; // scaled cd/m²
    vec3 emitted;   // scaled cd/m²; negative for small emitters
    float opacity;
    vec3 normal; // unit
};

uvec4 vct_pack(vct_lit_face r)
{
    return uvec4(packHalf2x16(r.reflected.rg), packHalf2x16(vec2(r.reflected.b, r.emitted.r)),
                 packHalf2x16(r.emitted.gb),
                 vct_pack_normal(r.normal) | uint(roundEven(r.opacity * 255.0)) << 24);
}

vct_lit_face vct_unpack(uvec4 packed)
{
    vec2 middle = unpackHalf2x16(packed.y);
    vct_lit_face r;
    r.reflected = vec3(unpackHalf2x16(packed.x), middle.x);
    r.emitted = vec3(middle.y, unpackHalf2x16(packed.z));
    r.normal = vct_unpack_normal(packed.w & 0xffffffu);
    r.opacity = float(packed.w >> 24) / 255.0;
    return r;
}

// Emitted radiance, with or without small emitters.
vec3 vct_emitted(vec3 emitted, bool small_emitters)
{
    return small_emitters ? abs(emitted) : max(emitted, vec3(0.0));
}

vct_lit_face vct_lit_face_at(usampler2D records, uint slot)
{
    return vct_unpack(texelFetch(records, vct_face_texel(slot), 0));
}

#endif
