// The place of a pixel's surface in a light map, by the triangle that FRAME_ID names. Include
// frame/frame.glsl and frame/octahedral.glsl first.
#ifndef AG_LIGHT_MAP_SURFACE_GLSL
#define AG_LIGHT_MAP_SURFACE_GLSL

#include "techniques/common/light_map/surface_shared.h"
#include "techniques/common/light_map/triangle.glsl"

layout(constant_id = LIGHT_MAP_HAS_BACKS) const bool HAS_BACKS = true;
layout(constant_id = LIGHT_MAP_HAS_MOVES) const bool HAS_MOVES = true;
layout(set = 0, binding = LIGHT_MAP_INSTANCES_BINDING, scalar) readonly buffer light_map_first
{
    uint first_triangle_table[]; // of each instance, and the end
};
layout(set = 0, binding = LIGHT_MAP_TRIANGLES_BINDING, scalar) readonly buffer light_map_triangles
{
    light_map_triangle triangle_table[];
};
layout(set = 0, binding = LIGHT_MAP_MOVES_BINDING, scalar) readonly buffer light_map_moves
{
    light_map_move move_table[];
};

// A point of a surface when the map was made.
struct light_map_surface {
    vec3 position, normal;
    vec3 to_viewer; // not of length 1
};

light_map_surface light_map_surface_moved(light_map_surface s, light_map_move move)
{
    mat3 turn = mat3(move.x, move.y, move.z);
    s.normal = turn * s.normal;
    s.normal /= max(length(s.normal), 1e-20);
    return light_map_surface(turn * s.position + move.by, s.normal, turn * s.to_viewer);
}

// A triangle of the scene, in triangle_table. ids: of FRAME_ID.
uint light_map_scene_triangle(uvec2 ids, light_map_instances instances)
{
    if (ids.x == 0u || ids.x > instances.count) return LIGHT_MAP_NO_TRIANGLE;
    uint first = first_triangle_table[ids.x - 1u];
    uint triangle = light_map_triangle_of(ids, first_triangle_table[ids.x] - first);
    return triangle == LIGHT_MAP_NO_TRIANGLE ? triangle : first + triangle;
}

// Whether the map has the triangle, which is that of `ids`, and knows where it was.
bool light_map_knows(light_map_triangle t, uvec2 ids, light_map_instances instances)
{
    if (vec4(t.u_axis, t.offset.x) == vec4(0.0, 0.0, 0.0, -1.0)) return false;
    return !HAS_MOVES || ids.x > instances.moved || move_table[ids.x - 1u].x != vec3(0.0);
}

bool light_map_has(uvec2 ids, light_map_instances instances)
{
    uint triangle = light_map_scene_triangle(ids, instances);
    return triangle != LIGHT_MAP_NO_TRIANGLE &&
           light_map_knows(triangle_table[triangle], ids, instances);
}

// In texels; z: the side, 0 or 1, negative where there is none. Moves the surface of an instance
// that has moved since.
vec3 light_map_place_in(uint triangle, uvec2 ids, light_map_instances instances,
                        inout light_map_surface s)
{
    if (triangle == LIGHT_MAP_NO_TRIANGLE) return vec3(-1.0);
    light_map_triangle t = triangle_table[triangle];
    vec4 u = vec4(t.u_axis, t.offset.x), v = vec4(t.v_axis, t.offset.y);
    if (!light_map_knows(t, ids, instances)) return vec3(-1.0);
    if (HAS_MOVES && ids.x <= instances.moved)
        s = light_map_surface_moved(s, move_table[ids.x - 1u]);
    bool back = false;
    if (HAS_BACKS && t.front != LIGHT_MAP_ONE_SIDED)
        back = dot(octahedral_direction(unpackSnorm2x16(t.front)), s.to_viewer) < 0.0;
    return vec3(dot(u, vec4(s.position, 1.0)), dot(v, vec4(s.position, 1.0)), back ? 1.0 : 0.0);
}

vec3 light_map_place_of(uvec2 ids, light_map_instances instances, inout light_map_surface s)
{
    return light_map_place_in(light_map_scene_triangle(ids, instances), ids, instances, s);
}

#endif
