// Compute passes over triangles, dispatched by scene_gpu_dispatch in work groups of
// SCENE_TRIANGLES_LOCAL invocations. Bindings as in scene.glsl; 7 holds the indices. IS_MASKED is a
// pipeline variant.
#ifndef AG_FRAME_SCENE_TRIANGLES_GLSL
#define AG_FRAME_SCENE_TRIANGLES_GLSL

#include "frame/scene/scene_gpu_shared.h"

layout(push_constant, scalar) uniform push_block
{
    scene_push draw;
    uint first_index, triangle_count;
    uint mirrored; // the transform reverses the winding order
}
push;

#define SCENE_VERTEX
#define SCENE_VERTEX_SURFACE
#include "frame/scene/scene.glsl"

layout(set = 0, binding = 7, scalar) readonly buffer scene_indices
{
    uint scene_index_table[];
};
layout(set = 0, binding = 8) uniform sampler2D base_color_map;

// Vertices of triangle i of the dispatch.
uvec3 scene_triangle(uint i)
{
    uint at = push.first_index + 3u * i;
    return uvec3(scene_index_table[at], scene_index_table[at + 1u], scene_index_table[at + 2u]);
}

// World positions as columns.
mat3 scene_triangle_positions(uvec3 vertices)
{
    mat4x3 world = mat4x3(scene_world_from_instance());
    return mat3(world * vec4(scene_position(vertices.x), 1.0),
                world * vec4(scene_position(vertices.y), 1.0),
                world * vec4(scene_position(vertices.z), 1.0));
}

// Alpha test at a point of the triangle.
bool scene_triangle_solid(uvec3 vertices, vec3 barycentric)
{
    if (!IS_MASKED) return true;
    vec2 uv = vec2(0.0);
    float alpha = 0.0;
    for (int k = 0; k < 3; k++) {
        scene_surface surface = scene_surface_of(vertices[k]);
        uv += barycentric[k] * scene_map_uv(SCENE_MAP_BASE_COLOR, surface);
        alpha += barycentric[k] * unpackUnorm4x8(surface.color).a;
    }
    float base_alpha = scene_material_table[push.draw.material].base_color.a;
    return alpha * base_alpha * textureLod(base_color_map, uv, 0.0).a >=
           scene_material_table[push.draw.material].alpha_cutoff;
}

#endif
