// The sun that is the only light of a frame: its maps and receivers in them. Include after
// shadow_resolved.glsl.
#ifndef AG_FRAME_DIRECT_SUN_GLSL
#define AG_FRAME_DIRECT_SUN_GLSL

#include "frame/direct/direct_shared.h"
#include "frame/shadow/shadow_block.glsl"

layout(set = 0, binding = 13, scalar) uniform first_shadow_faces
{
    shadow_face first_face_block[FRAME_MAX_CASCADES];
};
layout(set = 0, binding = 18, scalar) uniform shadow_sun
{
    shadow_sun_view sun_block;
};
layout(set = 0, binding = 15) uniform sampler2DArray shadow_sun_depths;
layout(set = 0, binding = 16) uniform sampler2DArray shadow_blocks;
layout(constant_id = DIRECT_CONSTANT_CASCADES) const int CASCADES = FRAME_MAX_CASCADES;

// Copies of the blocks, as with FRAME_CONSTANTS_COPIED: main begins with sun_load.
shadow_face first_face_table[FRAME_MAX_CASCADES];
shadow_sun_view sun;

void sun_load()
{
    sun = sun_block;
    first_face_table = first_face_block;
}

// Indices of cascades are literals: indexed by a loop, the copies would be arrays in memory.

// Whether a cascade other than the last is there and contains the position in its map.
bool sun_is_in(int cascade, vec3 position)
{
    return cascade < CASCADES - 1 && shadow_contains(position, sun.size);
}

void choose_receiver(int cascade, vec3 world, vec3 normal, vec3 to_viewer,
                     inout shadow_receiver chosen)
{
    shadow_receiver r = shadow_receiver_in(first_face_table[cascade], world, normal, to_viewer);
    if (cascade == CASCADES - 1 || sun_is_in(cascade, r.position)) chosen = r;
}

// The receiver in the finest cascade that contains it.
shadow_receiver sun_receiver(vec3 world, vec3 normal, vec3 to_viewer)
{
    shadow_receiver chosen;
    if (CASCADES > 3) choose_receiver(3, world, normal, to_viewer, chosen);
    if (CASCADES > 2) choose_receiver(2, world, normal, to_viewer, chosen);
    if (CASCADES > 1) choose_receiver(1, world, normal, to_viewer, chosen);
    choose_receiver(0, world, normal, to_viewer, chosen);
    return chosen;
}

struct sun_map {
    vec3 scale, offset; // of shadow_sun_view
    int layer;
};

void choose_map(int cascade, vec3 last, inout sun_map chosen)
{
    if (!sun_is_in(cascade, last * sun.scale[cascade] + sun.offset[cascade])) return;
    chosen = sun_map(sun.scale[cascade], sun.offset[cascade], sun.layer[cascade]);
}

// What is known about the receiver at a distance along a view ray: SHADOW_….
int sun_known(vec3 ray, float view_distance, vec3 normal)
{
    mat3 world_from_map = mat3(sun.map_from_world[0], sun.map_from_world[1], sun.map_from_world[2]);
    vec3 last = sun.viewer + view_distance * (ray * world_from_map);
    sun_map map = sun_map(vec3(1.0), vec3(0.0), sun.layer[CASCADES - 1]);
    choose_map(2, last, map);
    choose_map(1, last, map);
    choose_map(0, last, map);
    shadow_sun_receiver r;
    r.position = last * map.scale + map.offset;
    r.normal = normal * world_from_map * map.scale;
    r.to_viewer = (sun.viewer - last) * map.scale;
    r.layer = map.layer;
    return shadow_known(shadow_blocks, r, sun.size);
}

#endif
