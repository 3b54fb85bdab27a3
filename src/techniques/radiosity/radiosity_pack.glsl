// A radiosity in two words: sign, exponent and 12 bits of the mantissa of each colour.
#ifndef AG_RADIOSITY_PACK_GLSL
#define AG_RADIOSITY_PACK_GLSL

#include "techniques/common/light_map/table.glsl"
#include "techniques/radiosity/radiosity_shared.h"

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

#endif
