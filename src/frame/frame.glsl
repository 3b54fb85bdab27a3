// The frame's uniform block and functions of it. Include this instead of frame_shared.h: in GLSL a
// struct and a block cannot share a name, so the struct is renamed here.
//
// Binding number: FRAME_CONSTANTS_BINDING, 0 unless defined before the inclusion. Needs
// GL_EXT_scalar_block_layout. With FRAME_CONSTANTS_COPIED, `frame` is a copy that main begins with:
// frame = frame_block. Inside of branches, software drivers load a uniform block per invocation.
#ifndef AG_FRAME_GLSL
#define AG_FRAME_GLSL

#include "core/half.glsl"
#include "core/math.glsl"

#define frame_constants frame_constants_data
#include "frame/frame_shared.h"
#undef frame_constants

#ifndef FRAME_CONSTANTS_BINDING
#define FRAME_CONSTANTS_BINDING 0
#endif

#ifdef FRAME_CONSTANTS_COPIED
layout(set = 0, binding = FRAME_CONSTANTS_BINDING, scalar) uniform frame_constants
{
    frame_constants_data frame_block;
};
frame_constants_data frame;
#else
layout(set = 0, binding = FRAME_CONSTANTS_BINDING, scalar) uniform frame_constants
{
    frame_constants_data frame;
};
#endif

// Whether a pixel's surface reflects light, by the alpha of FRAME_ALBEDO: 0 without a surface, ½
// for unlit materials, 1 else.
bool frame_is_lit(float alpha)
{
    return alpha > 0.75;
}

// Centre of a pixel in 0…1, +y down.
vec2 frame_uv(uvec2 pixel)
{
    return (vec2(pixel) + 0.5) / vec2(frame.width, frame.height);
}

// World position at a screen position (0…1, +y down) and a depth > 0.
vec3 frame_world_position(vec2 uv, float depth)
{
    vec4 h = frame.world_from_clip * vec4(uv * 2.0 - 1.0, depth, 1.0);
    return h.xyz / h.w;
}

// World direction through a screen position, of length 1 along the view axis: the surface is at
// frame_ray_origin + frame_view_distance · ray.
vec3 frame_view_ray(vec2 uv)
{
    vec2 clip = uv * 2.0 - 1.0;
    return frame.ray_x * clip.x + frame.ray_y * clip.y + frame.ray;
}

// camera_position, but for orthographic views.
vec3 frame_ray_origin(vec2 uv)
{
    vec2 clip = uv * 2.0 - 1.0;
    return frame.origin_x * clip.x + frame.origin_y * clip.y + frame.origin;
}

// Metres along the view axis of a depth > 0.
float frame_view_distance(float depth)
{
    vec4 m = frame.distance_of_depth;
    return (m.x + m.y * depth) / (m.z + m.w * depth);
}

// From a point to the viewer: not of length 1.
vec3 frame_to_viewer(vec3 position)
{
    return frame.viewer.xyz - frame.viewer.w * position;
}

// View space: x right, y down, z forward.
vec3 frame_view_position(ivec2 pixel, float view_distance)
{
    vec2 lateral = frame.image_plane.xy + frame.image_plane.zw * vec2(pixel);
    return vec3(lateral * mix(1.0, view_distance, frame.viewer.w), view_distance);
}

#endif
