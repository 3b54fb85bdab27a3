// Places of a light map in tables (surface.h).
#ifndef AG_LIGHT_MAP_PLACE_GLSL
#define AG_LIGHT_MAP_PLACE_GLSL

#include "techniques/common/light_map/surface_shared.h"

// x, y: texel; z: side.
uvec3 light_map_place(uint word)
{
    const uint mask = (1u << LIGHT_MAP_PLACE_BITS) - 1u;
    return uvec3(word & mask, word >> LIGHT_MAP_PLACE_BITS & mask,
                 word >> 2 * LIGHT_MAP_PLACE_BITS);
}

#endif
