// Rows of operators, four numbers at a time, as half floats or floats.
#ifndef AG_MRT_OPERATORS_GLSL
#define AG_MRT_OPERATORS_GLSL

#include "techniques/mrt/mrt_shared.h"

layout(constant_id = MRT_CONSTANT_HALF) const bool MRT_HALF = true;
layout(constant_id = MRT_CONSTANT_QUADS_B) const uint QUADS_B = 8;
layout(constant_id = MRT_CONSTANT_QUADS_R) const uint QUADS_R = 8;

// Numbers 4 i … 4 i + 3 of an array of words.
#define MRT_QUAD(words, i)                                                                         \
    (MRT_HALF ? vec4(unpackHalf2x16(words[2u * (i)]), unpackHalf2x16(words[2u * (i) + 1u]))        \
              : uintBitsToFloat(uvec4(words[4u * (i)], words[4u * (i) + 1u], words[4u * (i) + 2u], \
                                      words[4u * (i) + 3u])))

#endif
