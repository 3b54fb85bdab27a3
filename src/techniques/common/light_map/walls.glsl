// Lookups beside walls that stand on a surface (map_shared.h).
#ifndef AG_LIGHT_MAP_WALLS_GLSL
#define AG_LIGHT_MAP_WALLS_GLSL

#include "techniques/common/light_map/map_shared.h"

// LIGHT_MAP_WALLS_BINDING: of the image [side] with the two words of each texel.
layout(set = 0, binding = LIGHT_MAP_WALLS_BINDING) uniform usampler2DArray light_map_walls;

// Moves a place, whose z is its side, to where bilinear lookups read no texel behind a wall.
vec2 light_map_before_wall(vec3 place)
{
    vec2 texel = floor(place.xy), at = place.xy - texel - 0.5;
    uvec2 wall = texelFetch(light_map_walls, max(ivec3(texel, place.z), ivec3(0)), 0).rg;
    vec2 normal = unpackSnorm4x8(wall.x).xy;
    uint from = dot(normal, at) > unpackSnorm2x16(wall.x).y ? uint(LIGHT_MAP_WALL_SIDE) : 0u;
    from += at.x < 0.0 ? 0u : uint(LIGHT_MAP_WALL_QUARTER);
    from += at.y < 0.0 ? 0u : 2u * uint(LIGHT_MAP_WALL_QUARTER);
    uint code = wall.y >> from;
    vec2 centre = vec2(float(code & 3u), float(code >> 2 & 3u)) - 2.0;
    at = vec2((code & 3u) == 0u ? at.x : centre.x, (code >> 2 & 3u) == 0u ? at.y : centre.y);
    return texel + 0.5 + at;
}

#endif
