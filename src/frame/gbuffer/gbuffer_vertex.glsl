// Vertex shader of the G-buffer; GBUFFER_MOTION adds positions of the previous frame. With
// GBUFFER_ID the draw is not indexed, so that the triangle is known: gl_PrimitiveID needs the
// optional feature geometryShader.
#define SCENE_VERTEX
#define SCENE_VERTEX_SURFACE
#define SCENE_VERTEX_FRAME
#include "frame/frame.glsl"
#include "frame/gbuffer/gbuffer_varyings.glsl"
#include "frame/scene/scene.glsl"

#ifdef GBUFFER_ID
layout(set = 0, binding = 7, scalar) readonly buffer scene_indices
{
    uint scene_index_table[];
};

uint pulled_vertex()
{
    vary_triangle = push.first_triangle + uint(gl_VertexIndex) / 3u;
    return scene_index_table[push.first_index + uint(gl_VertexIndex)];
}
#else
uint pulled_vertex()
{
    return uint(gl_VertexIndex);
}
#endif

void main()
{
    uint vertex = pulled_vertex();
    mat4 world_from_instance = scene_world_from_instance();
    precise vec4 world = vec4((world_from_instance * vec4(scene_position(vertex), 1.0)).xyz, 1.0);
    precise vec4 clip = frame.clip_from_world * world;
    gl_Position = clip;

    scene_frame f = scene_frame_of(vertex, world_from_instance);
    vary_normal = f.normal;
    vary_tangent = f.tangent;
    scene_surface surface = scene_surface_of(vertex);
    vary_base_color_uv =
        HAS_BASE_COLOR_MAP ? scene_map_uv(SCENE_MAP_BASE_COLOR, surface) : vec2(0.0);
    vary_metallic_roughness_uv = HAS_METALLIC_ROUGHNESS_MAP
                                     ? scene_map_uv(SCENE_MAP_METALLIC_ROUGHNESS, surface)
                                     : vec2(0.0);
    vary_normal_uv = HAS_NORMAL_MAP ? scene_map_uv(SCENE_MAP_NORMAL, surface) : vec2(0.0);
    vary_emissive_uv = HAS_EMISSIVE_MAP ? scene_map_uv(SCENE_MAP_EMISSIVE, surface) : vec2(0.0);
#ifdef GBUFFER_DIELECTRIC
    vary_specular_uv = scene_map_uv(SCENE_MAP_SPECULAR, surface);
    vary_specular_color_uv = scene_map_uv(SCENE_MAP_SPECULAR_COLOR, surface);
#endif
    vary_color = unpackUnorm4x8(surface.color);
#ifdef GBUFFER_MOTION
    // Precise, so that both positions of a static surface are rounded alike.
    precise vec4 before = vec4(
        (scene_previous_world_from_instance() * vec4(scene_previous_position(vertex), 1.0)).xyz,
        1.0);
    precise vec4 previous = frame.previous_clip_from_world * before;
    // Orthographic: w is 1. Without a branch, as software drivers compile a shader again for each
    // block of uniforms that alone decides one.
    precise float current_z = mix(dot(frame.axis, world), clip.w, frame.viewer.w);
    precise float previous_z = mix(dot(frame.previous_axis, before), previous.w, frame.viewer.w);
    vary_current = vec3(clip.xy, current_z);
    vary_previous = vec3(previous.xy, previous_z);
#endif
}
