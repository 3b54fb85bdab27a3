#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Depth of opaque shadow casters: positions only.
#define SCENE_VERTEX
#include "frame/scene/scene_gpu_shared.h"

layout(push_constant, scalar) uniform push_block
{
    scene_push draw;
    mat4 clip_from_world;
}
push;

#include "frame/scene/scene.glsl"

void main()
{
    vec4 world = scene_world_from_instance() * vec4(scene_position(uint(gl_VertexIndex)), 1.0);
    gl_Position = push.clip_from_world * vec4(world.xyz, 1.0);
}
