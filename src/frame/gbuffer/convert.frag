// Converts a caller's G-buffer into the frame's own: see gbuffer_encoding.h. Formats: frame.h.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#define gbuffer_encoding gbuffer_encoding_data
#include "frame/gbuffer/gbuffer_encoding.h"
#undef gbuffer_encoding
#include "frame/gbuffer/gbuffer_targets.glsl"
#include "frame/octahedral.glsl"

layout(set = 0, binding = 1, scalar) uniform gbuffer_encoding
{
    gbuffer_encoding_data from;
};
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler2D albedo;
// Absent images have another one in their place.
layout(set = 0, binding = 5) uniform sampler2D material;
layout(set = 0, binding = 6) uniform sampler2D dielectric;
layout(set = 0, binding = 7) uniform sampler2D emissive;
layout(set = 0, binding = 8) uniform sampler2D motion;

vec2 converted_normal(vec4 value)
{
    vec3 n = value.xyz * from.normal_scale + from.normal_bias;
    bool octahedral = from.normal_octahedral != 0u;
    if (octahedral && from.normal_in_view_space == 0u) return n.xy;
    if (octahedral) n = octahedral_decode(n.xy);
    if (from.normal_in_view_space != 0u) n = n * mat3(frame.view_from_world);
    float length2 = dot(n, n);
    return octahedral_encode(length2 > 1e-12 ? n * inversesqrt(length2) : vec3(0.0, 1.0, 0.0));
}

float channel_of(vec4 value, uint channel, float absent)
{
    return channel < GBUFFER_NO_CHANNEL ? value[channel] : absent;
}

vec2 converted_material(vec4 value)
{
    if (from.has_material == 0u) return vec2(1.0, 0.0);
    return vec2(channel_of(value, from.roughness, 1.0), channel_of(value, from.metallic, 0.0));
}

#ifdef GBUFFER_MOTION
// Previous over current distance of a point that does not move, minus 1.
float distance_change(vec2 uv, float depth)
{
    float distance_m = frame_view_distance(depth);
    vec3 position = frame_ray_origin(uv) + distance_m * frame_view_ray(uv);
    return max(dot(frame.previous_axis, vec4(position, 1.0)), 0.0) / distance_m - 1.0;
}

vec4 converted_motion(vec4 value, vec2 uv, float depth)
{
    vec2 moved = value.xy * vec2(from.motion_scale_x, from.motion_scale_y) +
                 vec2(from.motion_offset_x, from.motion_offset_y);
    float change = from.motion_has_distance != 0u ? value.z : distance_change(uv, depth);
    return vec4(clamp(vec3(moved, change), -HALF_MAX, HALF_MAX), 1.0);
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float own_depth = texelFetch(depth, pixel, 0).r;
    float converted_depth = from.depth_offset + from.depth_scale * own_depth;
    if (own_depth == from.depth_without_surface || !(converted_depth > 0.0)) discard;
    gl_FragDepth = converted_depth;
    vec4 reflectance = texelFetch(albedo, pixel, 0);
    out_albedo = vec4(reflectance.rgb, from.albedo_alpha != 0u ? reflectance.a : 1.0);
    out_normal = converted_normal(texelFetch(normal, pixel, 0));
    out_material = converted_material(texelFetch(material, pixel, 0));
    out_emissive = from.has_emissive != 0u ? texelFetch(emissive, pixel, 0) : vec4(0.0);
#ifdef GBUFFER_DIELECTRIC
    out_dielectric = texelFetch(dielectric, pixel, 0);
#endif
#ifdef GBUFFER_MOTION
    out_motion =
        converted_motion(texelFetch(motion, pixel, 0), frame_uv(uvec2(pixel)), converted_depth);
#endif
}
