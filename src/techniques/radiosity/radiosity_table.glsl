// Tables in images (radiosity_table.h).
#ifndef AG_RADIOSITY_TABLE_GLSL
#define AG_RADIOSITY_TABLE_GLSL

#include "core/half.glsl"
#include "techniques/radiosity/radiosity_shared.h"

// The texel of an entry.
ivec2 radiosity_at(uint entry)
{
    return ivec2(entry % RADIOSITY_TABLE_WIDTH, entry / RADIOSITY_TABLE_WIDTH);
}

// A radiosity in two words: sign, exponent and 12 bits of the mantissa of each colour.
uvec2 radiosity_pack(vec3 value)
{
    uvec3 b = floatBitsToUint(value) + (1u << 10); // rounds
    b >>= 11;
    return uvec2(b.r | b.g << 21, b.g >> 11 | b.b << 10);
}

vec3 radiosity_unpack(uvec2 words)
{
    return uintBitsToFloat(
        uvec3(words.x << 11, (words.x >> 21 | words.y << 11) << 11, (words.y & ~0x3ffu) << 1));
}

// Irradiance and vector irradiance as four halves.
uvec2 radiosity_pack_light(vec4 light)
{
    light = clamp(light, -HALF_MAX, HALF_MAX);
    return uvec2(packHalf2x16(light.xy), packHalf2x16(light.zw));
}

vec4 radiosity_unpack_light(uvec2 words)
{
    return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y));
}

#ifdef RADIOSITY_LIGHT_BINDING
layout(set = 0, binding = RADIOSITY_LIGHT_BINDING,
       rg32ui) uniform readonly uimage2D radiosity_light; // [colour][texel]

vec4 radiosity_light_of(uint texel, uint texels, int colour)
{
    return radiosity_unpack_light(
        imageLoad(radiosity_light, radiosity_at(colour * texels + texel)).xy);
}
#endif

#endif
