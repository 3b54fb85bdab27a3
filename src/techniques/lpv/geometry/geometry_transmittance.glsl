// Which share of a cell's light reaches each of its neighbours: what geometry lets through, of each
// step the same. Include after lpv_grid.glsl; define LPV_TRANSMITTANCE_BINDING, and
// LPV_TRANSMITTANCE_ACCESS (readonly or writeonly).
//
// A word has four shares of 8 bits. With six neighbours those along axis a are in word a: −, +.
// With 26 those at the offset (x, y, z) are in word 3 (y + 1) + x + 1, at z + 1.
#ifndef AG_LPV_TRANSMITTANCE_GLSL
#define AG_LPV_TRANSMITTANCE_GLSL

layout(constant_id = LPV_CONSTANT_NEIGHBOURS) const int LPV_NEIGHBOURS = 6;

layout(set = 0, binding = LPV_TRANSMITTANCE_BINDING,
       scalar) LPV_TRANSMITTANCE_ACCESS buffer lpv_transmittance
{
    uint transmittance_words[]; // [cell][word]
};

const int LPV_TRANSMITTANCE_WORDS =
    LPV_NEIGHBOURS == 26 ? LPV_TRANSMITTANCE_WORDS_26 : LPV_TRANSMITTANCE_WORDS_6; // of a cell

#endif
