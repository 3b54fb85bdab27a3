// Radiosities, and rows of form factors.
#ifndef AG_RADIOSITY_PACK_GLSL
#define AG_RADIOSITY_PACK_GLSL

#include "techniques/common/light_map/table.glsl"
#include "techniques/radiosity/radiosity_shared.h"

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

// Rows are in tiles of as many as a processor computes at once: the entries of a tile are one after
// another, those of its rows side by side.
uint radiosity_source(uint word)
{
    return word & ((1u << RADIOSITY_NODE_BITS) - 1u);
}

float radiosity_form_factor(uint word)
{
    return unpackHalf2x16(word >> RADIOSITY_NODE_BITS).x;
}

// The texel of a block's table with entry k of a row; its tile begins at `first`.
uint radiosity_row_texel(uint first, uint k, uint row)
{
    return first + RADIOSITY_TILE * k + row % RADIOSITY_TILE;
}

#endif
