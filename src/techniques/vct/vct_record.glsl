// What a lit voxel is, as 8 words: what its two sides send out, and what light on them would add. Half floats and
// bytes.
#ifndef AG_VCT_RECORD_GLSL
#define AG_VCT_RECORD_GLSL

#include "frame/octahedral.glsl"

struct vct_record
{
    vec3 front, back;                   // scaled cd/m²: reflected light of lights
    vec3 emitted_front, emitted_back;   // scaled cd/m²
    vec3 reflectance;
    vec2 opacity;                       // to ways that meet the front, the back
    vec3 normal;                        // unit, of the front; 0 where the sides cannot be told apart
};

void vct_pack(vct_record r, out uint words[VCT_RECORD_WORDS])
{
    words[0] = packHalf2x16(r.front.rg);
    words[1] = packHalf2x16(vec2(r.front.b, r.back.r));
    words[2] = packHalf2x16(r.back.gb);
    words[3] = packHalf2x16(r.emitted_front.rg);
    words[4] = packHalf2x16(vec2(r.emitted_front.b, r.emitted_back.r));
    words[5] = packHalf2x16(r.emitted_back.gb);
    words[6] = packUnorm4x8(vec4(r.reflectance, r.opacity.x));
    // 12 + 12 + 8 bits. Fronts turn to one half of all ways (vct_add.glsl), and none of these has the code 0.
    uvec2 normal = uvec2(roundEven((octahedral_encode(r.normal) * 0.5 + 0.5) * 4095.0));
    words[7] = (r.normal == vec3(0.0) ? 0u : normal.x | normal.y << 12) | uint(roundEven(r.opacity.y * 255.0)) << 24;
}

vct_record vct_unpack(uint words[VCT_RECORD_WORDS])
{
    vec2 a = unpackHalf2x16(words[1]), b = unpackHalf2x16(words[4]);
    vec4 c = unpackUnorm4x8(words[6]);
    vct_record r;
    r.front = vec3(unpackHalf2x16(words[0]), a.x);
    r.back = vec3(a.y, unpackHalf2x16(words[2]));
    r.emitted_front = vec3(unpackHalf2x16(words[3]), b.x);
    r.emitted_back = vec3(b.y, unpackHalf2x16(words[5]));
    r.reflectance = c.rgb;
    r.opacity = vec2(c.a, float(words[7] >> 24) / 255.0);
    uint normal = words[7] & 0xffffffu;
    r.normal = normal == 0u ? vec3(0.0) : octahedral_decode(vec2(normal & 4095u, normal >> 12) / 4095.0 * 2.0 - 1.0);
    return r;
}

#endif
