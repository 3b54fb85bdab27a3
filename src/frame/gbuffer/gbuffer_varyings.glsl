// Interpolants of the G-buffer. VARY is `in` for the fragment shader and `out` for the vertex
// shader.
#ifdef GBUFFER_FRAGMENT
#define VARY in
#else
#define VARY out
#endif

layout(location = 0) VARY vec3 vary_normal;
layout(location = 1) VARY vec4 vary_tangent;
layout(location = 2) VARY vec4 vary_color;
layout(location = 3) VARY vec2 vary_base_color_uv;
layout(location = 4) VARY vec2 vary_metallic_roughness_uv;
layout(location = 5) VARY vec2 vary_normal_uv;
layout(location = 6) VARY vec2 vary_emissive_uv;
#ifdef GBUFFER_MOTION
// Clip-space x and y, and the distance along the axis, of this frame and the previous one. Both are
// interpolated alike, so that static surfaces have a motion of exactly 0.
layout(location = 7) VARY vec3 vary_current;
layout(location = 8) VARY vec3 vary_previous;
#endif

#ifdef GBUFFER_DIELECTRIC
layout(location = 9) VARY vec2 vary_specular_uv;
layout(location = 10) VARY vec2 vary_specular_color_uv;
#endif

#ifdef GBUFFER_ID
layout(location = 11) flat VARY uint vary_triangle; // of the mesh
#endif

layout(push_constant, scalar) uniform push_block
{
    scene_push draw;
#ifdef GBUFFER_ID
    uint first_index, first_triangle;
#endif
}
push;
