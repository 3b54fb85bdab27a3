#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Vertex shader of reflective shadow maps.
#define SCENE_VERTEX
#define SCENE_VERTEX_SURFACE
#define SCENE_VERTEX_FRAME
#include "frame/frame.glsl"
#include "frame/rsm/rsm_varyings.glsl"
#include "frame/scene/scene.glsl"

void main()
{
    uint vertex = uint(gl_VertexIndex);
    mat4 world_from_instance = scene_world_from_instance();
    vary_world = (world_from_instance * vec4(scene_position(vertex), 1.0)).xyz;
    gl_Position = rsm_face_table[push.face].clip_from_world * vec4(vary_world, 1.0);
    vary_normal = scene_frame_of(vertex, world_from_instance).normal;
    scene_surface surface = scene_surface_of(vertex);
    vary_base_color_uv =
        HAS_BASE_COLOR_MAP ? scene_map_uv(SCENE_MAP_BASE_COLOR, surface) : vec2(0.0);
    vary_metallic_roughness_uv = HAS_METALLIC_ROUGHNESS_MAP
                                     ? scene_map_uv(SCENE_MAP_METALLIC_ROUGHNESS, surface)
                                     : vec2(0.0);
    vary_color = unpackUnorm4x8(surface.color);
}
