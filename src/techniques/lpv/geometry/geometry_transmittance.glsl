// Fraction of a cell's light that geometry transmits to each of its neighbours, equal for all
// steps. Include after lpv_grid.glsl; define LPV_TRANSMITTANCE_BINDING and LPV_TRANSMITTANCE_ACCESS
// (readonly or writeonly).
//
// A word holds four values of 8 bits. Six neighbours: word a holds those along axis a: −, +.
// 26 neighbours: word 3 (y + 1) + x + 1 holds those at the offset (x, y, z), at z + 1.
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
