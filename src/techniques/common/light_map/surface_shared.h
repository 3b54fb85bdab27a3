// Surfaces of a scene in the atlas of a light map. Scalar layout.
#ifndef AG_LIGHT_MAP_SURFACE_SHARED_H
#define AG_LIGHT_MAP_SURFACE_SHARED_H

#include "core/shared.h"

// Normal of the front of a triangle that has two sides in the map, as octahedral_pack (frame/
// octahedral.h), which does not give this word: that of triangles with one.
#define LIGHT_MAP_ONE_SIDED 0x8000u

// Specialization constants: whether some triangles have two sides in the map, and whether some
// instances may have a move. A driver on a processor loads the rows of both without a use.
#define LIGHT_MAP_HAS_BACKS 64
#define LIGHT_MAP_HAS_MOVES 65

// Layers of a light map for one side of the surfaces: one for each colour.
#define LIGHT_MAP_LAYERS 3

// Bits of x and of y in the word of a place of the light map: y above x, above both the side.
#define LIGHT_MAP_PLACE_BITS 15

// A triangle of the scene. In the atlas it is at axis · position + offset, in texels.
struct light_map_triangle {
    vec3s u_axis, v_axis; // texels per metre
    vec2s offset;         // (−1, 0) and no axes: it is not in the map
    uint32_t front;
};

// From the present pose of an instance to that of the map: p.x x + p.y y + p.z z + by. 0: the map
// does not have it.
struct light_map_move {
    vec3s x, y, z, by;
};

// Instances of the scene in the map, and those with a row in light_map_moves: all or none.
struct light_map_instances {
    uint32_t count, moved;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct light_map_triangle) == 36, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_move) == 48, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_instances) == 8, "layout is shared with GLSL");
#endif

#endif
