#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Depth of alpha-masked shadow casters.
#define SCENE_VERTEX
#define SCENE_VERTEX_SURFACE
#include "frame/scene/scene_gpu_shared.h"

layout(push_constant, scalar) uniform push_block
{
    scene_push draw;
    mat4 clip_from_world;
}
push;

#include "frame/scene/scene.glsl"

layout(location = 0) out vec2 vary_base_color_uv;
layout(location = 1) out vec4 vary_color;

void main()
{
    uint vertex = uint(gl_VertexIndex);
    vec4 world = scene_world_from_instance() * vec4(scene_position(vertex), 1.0);
    gl_Position = push.clip_from_world * vec4(world.xyz, 1.0);
    scene_surface surface = scene_surface_of(vertex);
    vary_base_color_uv =
        HAS_BASE_COLOR_MAP ? scene_map_uv(SCENE_MAP_BASE_COLOR, surface) : vec2(0.0);
    vary_color = unpackUnorm4x8(surface.color);
}
