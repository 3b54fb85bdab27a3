// Walls that stand on a surface with a light map. A texel may reach through one. A bilinear lookup
// beside one must not read texels whose sample points are behind it: their light is that of the
// other side.
#pragma once

#include "trace/texels/texels.h"

// Along an axis of the atlas: the lookup stays, or is at the centre of this texel, or of the one
// before or after it.
enum texel_lookup { LOOKUP_STAYS, LOOKUP_BEFORE, LOOKUP_CENTRE, LOOKUP_AFTER };
enum { WALL_SIDES = 2, WALL_QUARTERS = 4 };

// A wall divides a texel along the line normal·p = offset, with p from the texel's centre in the
// atlas, in texels. Side 1 is beyond it. Quarter 1 is after quarter 0 along x, 2 along y.
struct texel_wall {
    float normal[2], offset;
    uint8_t lookup[WALL_SIDES][WALL_QUARTERS][2]; // enum texel_lookup along x and y
};

// points: [side_texel_count] of texel_find_point. Without a wall near the texel all lookups stay.
struct texel_wall texel_find_wall(const struct trace_scene *scene, const struct charts *charts,
                                  const struct texel_point *points, uint32_t texel);

// Whether a wall hides the middles of some texels around from that of a texel, a quarter of a texel
// above the surface.
bool texel_is_beside_wall(const struct trace_scene *scene, const struct charts *charts,
                          uint32_t texel);
// The texel of a point `at` of a texel: itself or, if a wall hides its middle from there, one
// around it in the chart whose middle is visible; itself where none is.
uint32_t texel_before_wall(const struct trace_scene *scene, const struct charts *charts,
                           uint32_t texel, vec3s at);
