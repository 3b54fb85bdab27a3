#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Alpha test of masked shadow casters.
#define SCENE_FRAGMENT
#include "frame/scene/scene_gpu_shared.h"

layout(push_constant, scalar) uniform push_block
{
    scene_push draw;
    mat4 clip_from_world;
}
push;

#include "frame/scene/scene.glsl"

layout(location = 0) in vec2 vary_base_color_uv;
layout(location = 1) in vec4 vary_color;

void main()
{
    scene_base_color(vary_base_color_uv, vary_color);
}
