#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Direct light: emission, and the reflection of all punctual lights with their shadows. Where there
// is no surface, the sky.
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/direct/direct_shared.h"
#include "frame/light.glsl"
#include "frame/octahedral.glsl"
#include "frame/shadow/shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};
layout(set = 0, binding = 4) uniform sampler2D depth_layer;
layout(set = 0, binding = 5) uniform sampler2D normal_layer;
layout(set = 0, binding = 6) uniform sampler2D albedo_layer;
layout(set = 0, binding = 7) uniform sampler2D material_layer;
layout(set = 0, binding = 8) uniform sampler2D emissive_layer;
layout(set = 0, binding = 9, rgba16f) uniform writeonly image2D direct_layer;

layout(push_constant, scalar) uniform push_block
{
    direct_push push;
};

// Without it nothing is read but depth and emission: software drivers run the body of a loop once
// even where it has no turns.
layout(constant_id = 0) const bool HAS_LIGHTS = true;

struct surface {
    vec3 position, normal, to_eye;
    vec3 plane; // normal of the triangle, towards the eye
    vec3 diffuse, f0;
    float alpha;
};

// Depth at a pixel, kept within the picture.
float depth_at(ivec2 pixel)
{
    return texelFetch(depth_layer, clamp(pixel, ivec2(0), ivec2(frame.width, frame.height) - 1), 0)
        .r;
}

// Position of the neighbour along `axis` that lies on the pixel's own plane. Depth is affine in the
// picture on a plane: that side is taken where the two next pixels foretell this one's depth best,
// so that creases do not mix.
vec3 neighbour_on_plane(ivec2 pixel, ivec2 axis, float depth)
{
    float before = depth_at(pixel - axis), after = depth_at(pixel + axis);
    float miss_before = abs(2.0 * before - depth_at(pixel - 2 * axis) - depth);
    float miss_after = abs(2.0 * after - depth_at(pixel + 2 * axis) - depth);
    float side = miss_before < miss_after ? -1.0 : 1.0;
    // At the picture's rim the depth that was kept within is none of that place: the other side is
    // true.
    ivec2 end = ivec2(frame.width, frame.height) - 1;
    if (any(lessThan(pixel - 2 * axis, ivec2(0)))) side = 1.0;
    if (any(greaterThan(pixel + 2 * axis, end))) side = -1.0;
    vec2 uv = frame_uv(uvec2(pixel)) + side * vec2(axis) / vec2(frame.width, frame.height);
    return frame_world_position(uv, max(side < 0.0 ? before : after, 1e-12));
}

// Unit normal of the triangle in the pixel, towards the eye, from the depths around it.
vec3 plane_of(ivec2 pixel, float depth, vec3 position, vec3 to_eye)
{
    vec3 across = neighbour_on_plane(pixel, ivec2(1, 0), depth) - position;
    vec3 down = neighbour_on_plane(pixel, ivec2(0, 1), depth) - position;
    vec3 n = cross(across, down);
    float length2 = dot(n, n);
    if (!(length2 > 0.0)) return to_eye;
    n *= inversesqrt(length2);
    return dot(n, to_eye) < 0.0 ? -n : n;
}

surface read_surface(ivec2 pixel, float depth)
{
    surface s;
    s.position = frame_world_position(frame_uv(uvec2(pixel)), depth);
    s.normal = octahedral_decode(texelFetch(normal_layer, pixel, 0).rg);
    s.to_eye = normalize(frame.eye - s.position);
    s.plane = plane_of(pixel, depth, s.position, s.to_eye);
    vec3 albedo = texelFetch(albedo_layer, pixel, 0).rgb;
    vec2 material = texelFetch(material_layer, pixel, 0).rg;
    s.diffuse = brdf_diffuse(albedo, material.y);
    s.f0 = brdf_f0(albedo, material.y);
    s.alpha = brdf_alpha(material.x);
    return s;
}

// Radiance that one light makes the surface reflect to the eye.
vec3 reflected(surface s, frame_light light)
{
    vec3 to_light = -light.direction;
    float attenuation = 1.0;
    if (light.type != FRAME_LIGHT_SUN) {
        to_light = light.position - s.position;
        float distance2 = dot(to_light, to_light);
        to_light *= inversesqrt(max(distance2, 1e-12));
        attenuation = light_cone(light, -to_light) * light_window(light, distance2) /
                      max(distance2, LIGHT_MIN_DISTANCE_M * LIGHT_MIN_DISTANCE_M);
    }
    float cosine = dot(s.normal, to_light);
    bool facing = cosine > 0.0 && attenuation > 0.0;
    if (light.shadow_first >= 0)
        attenuation *= shadow_of(light, s.position, s.plane, to_light, facing, push.shadow_size,
                                 push.shadow_radius);
    if (!facing) return vec3(0.0);
    vec3 brdf = s.diffuse + brdf_specular(s.normal, s.to_eye, to_light, s.alpha, s.f0);
    return brdf * light.intensity * (attenuation * cosine);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
    float depth = texelFetch(depth_layer, pixel, 0).r;
    vec3 radiance = frame.sky;
    if (depth > 0.0) {
        radiance = texelFetch(emissive_layer, pixel, 0).rgb;
        if (HAS_LIGHTS) {
            surface s = read_surface(pixel, depth);
            for (uint i = 0; i < frame.light_count; i++)
                radiance += reflected(s, frame_light_table[i]);
        }
    }
    imageStore(direct_layer, pixel, vec4(min(radiance, vec3(HALF_MAX)), 1.0));
}
