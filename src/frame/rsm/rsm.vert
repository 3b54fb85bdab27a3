#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Surfaces as a light sees them.
#define SCENE_VERTEX
#define SCENE_VERTEX_SURFACE
#define SCENE_VERTEX_FRAME
#include "frame/frame.glsl"
#include "frame/rsm/rsm_varyings.glsl"
#include "frame/scene.glsl"

void main()
{
    uint vertex = uint(gl_VertexIndex);
    mat4 world_from_instance = scene_world_from_instance();
    vary_world = (world_from_instance * vec4(scene_position(vertex), 1.0)).xyz;
    gl_Position = rsm_face_table[push.face].clip_from_world * vec4(vary_world, 1.0);
    vary_normal = scene_frame_of(vertex, world_from_instance).normal;
    scene_surface surface = scene_surface_of(vertex);
    vary_uv0 = surface.uv0;
    vary_uv1 = surface.uv1;
    vary_color = unpackUnorm4x8(surface.color);
}
