// Rows of form factors, in tiles of as many as a processor computes at once: the entries of a tile
// are one after another, those of its rows side by side.
#ifndef AG_RADIOSITY_ROW_GLSL
#define AG_RADIOSITY_ROW_GLSL

#include "techniques/radiosity/radiosity_pack.glsl"

uint radiosity_source(uint word)
{
    return word & ((1u << RADIOSITY_NODE_BITS) - 1u);
}

float radiosity_form_factor(uint word)
{
    return unpackHalf2x16(word >> RADIOSITY_NODE_BITS).x;
}

// Of the table of a block: the k-th texel of a row, in a tile that begins at `first`.
uint radiosity_row_texel(uint first, uint k, uint row)
{
    return first + RADIOSITY_TILE * k + row % RADIOSITY_TILE;
}

#endif
