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

// Without branches: software drivers compile a shader again for each block of uniforms that alone
// decides one.
vec2 converted_normal(vec4 value)
{
    vec3 n = value.xyz * from.normal_scale + from.normal_bias;
    bool octahedral = from.normal_octahedral != 0u, in_view = from.normal_in_view_space != 0u;
    vec3 direction = mix(n, octahedral_decode(n.xy), bvec3(octahedral));
    direction = mix(direction, direction * mat3(frame.view_from_world), bvec3(in_view));
    float length2 = dot(direction, direction);
    direction = mix(vec3(0.0, 1.0, 0.0), direction * inversesqrt(length2), bvec3(length2 > 1e-12));
    return mix(octahedral_encode(direction), n.xy, bvec2(octahedral && !in_view));
}

float channel_of(vec4 value, uint channel, float absent)
{
    return mix(value[min(channel, 3u)], absent, channel >= GBUFFER_NO_CHANNEL);
}

vec2 converted_material(vec4 value)
{
    vec2 material =
        vec2(channel_of(value, from.roughness, 1.0), channel_of(value, from.metallic, 0.0));
    return mix(vec2(1.0, 0.0), material, bvec2(from.has_material != 0u));
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
    float change = mix(distance_change(uv, depth), value.z, from.motion_has_distance != 0u);
    vec3 result = clamp(vec3(moved, change), -HALF_MAX, HALF_MAX);
    // Rounding of a static surface: less than a 4000th of a pixel, or of the distance by 18 bits.
    vec3 least = vec3(2.5e-4 / vec2(frame.width, frame.height), 4e-6);
    return vec4(mix(result, vec3(0.0), lessThan(abs(result), least)), 1.0);
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
    out_albedo = vec4(reflectance.rgb, mix(1.0, reflectance.a, from.albedo_alpha != 0u));
    out_normal = converted_normal(texelFetch(normal, pixel, 0));
    out_material = converted_material(texelFetch(material, pixel, 0));
    vec4 emitted = clamp(texelFetch(emissive, pixel, 0), 0.0, HALF_MAX);
    out_emissive = mix(vec4(0.0), emitted, bvec4(from.has_emissive != 0u));
#ifdef GBUFFER_DIELECTRIC
    out_dielectric = texelFetch(dielectric, pixel, 0);
#endif
#ifdef GBUFFER_MOTION
    out_motion =
        converted_motion(texelFetch(motion, pixel, 0), frame_uv(uvec2(pixel)), converted_depth);
#endif
}
