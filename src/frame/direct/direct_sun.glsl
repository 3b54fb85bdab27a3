// The sun that is the only light of a frame: its maps and receivers in them. Include after
// shadow_resolved.glsl.
#ifndef AG_FRAME_DIRECT_SUN_GLSL
#define AG_FRAME_DIRECT_SUN_GLSL

#include "frame/direct/direct_shared.h"
#include "frame/shadow/shadow_block.glsl"

layout(set = 0, binding = 13, scalar) uniform shadow_sun
{
    shadow_sun_view sun_block;
};
layout(set = 0, binding = 15) uniform sampler2DArray shadow_sun_depths;
layout(set = 0, binding = 16) uniform sampler2DArray shadow_blocks;
layout(constant_id = DIRECT_CONSTANT_CASCADES) const int CASCADES = FRAME_MAX_CASCADES;

shadow_sun_view sun; // a copy, as FRAME_CONSTANTS_COPIED: main begins with sun = sun_block

struct sun_map {
    vec3 scale, offset; // of shadow_sun_view
    float depth;
    int layer;
};

// cascade: a literal. Indexed by a loop, the copy would be an array in memory.
void choose_map(int cascade, vec3 last, inout sun_map chosen)
{
    vec3 position = last * sun.scale[cascade] + sun.offset[cascade];
    if (cascade < CASCADES - 1 && shadow_contains(position, sun.size))
        chosen = sun_map(sun.scale[cascade], sun.offset[cascade], sun.depth[cascade],
                         sun.layer[cascade]);
}

// The receiver at a distance along a view ray, in the finest cascade that contains it.
shadow_receiver sun_receiver(vec3 ray, float view_distance, vec3 normal)
{
    mat3 world_from_map = mat3(sun.map_from_world[0], sun.map_from_world[1], sun.map_from_world[2]);
    vec3 last = sun.viewer + view_distance * (ray * world_from_map);
    sun_map map = sun_map(vec3(1.0), vec3(0.0), sun.depth[CASCADES - 1], sun.layer[CASCADES - 1]);
    choose_map(2, last, map);
    choose_map(1, last, map);
    choose_map(0, last, map);
    shadow_receiver r;
    r.position = last * map.scale + map.offset;
    r.normal = normal * world_from_map * map.scale;
    r.to_viewer = (sun.viewer - last) * map.scale;
    r.depth = map.depth;
    r.size = sun.size;
    r.layer = map.layer;
    return r;
}

#endif
