// The maps of one sun as the camera sees them, C and GLSL. Scalar layout. In GLSL, include after
// frame.glsl.
#ifndef AG_FRAME_SHADOW_SUN_SHARED_H
#define AG_FRAME_SHADOW_SUN_SHARED_H

#ifndef AG_GLSL
#include "frame/frame_shared.h"
#endif

// Uniform block "shadow_sun". Units of all three axes of a map are texels. A surface at a distance
// along frame_view_ray has the position viewer + distance · (map_from_world · ray) in the last map,
// and position · scale + offset in the map of a cascade.
struct shadow_sun_view {
    vec3s map_from_world[3]; // rows
    vec3s viewer;
    vec3s scale[FRAME_MAX_CASCADES], offset[FRAME_MAX_CASCADES];
    float depth[FRAME_MAX_CASCADES]; // texels per unit of stored depth
    int32_t layer[FRAME_MAX_CASCADES];
    float size; // of each map
    float padding[3];
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct shadow_sun_view) == 4 * (12 + 6 * FRAME_MAX_CASCADES + 12),
               "layout is shared with GLSL");
#endif

#endif
