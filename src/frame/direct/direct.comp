#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Direct light: emission, and the reflection of all punctual lights with their shadows. Where there is no surface, the sky.
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/direct/direct_shared.h"
#include "frame/light.glsl"
#include "frame/octahedral.glsl"
#include "frame/shadow/shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) readonly buffer frame_lights { frame_light frame_light_table[]; };
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

struct surface
{
    vec3 position, normal, to_eye;
    vec3 diffuse, f0;
    float alpha;
};

surface read_surface(ivec2 pixel, float depth)
{
    surface s;
    s.position = frame_world_position(frame_uv(uvec2(pixel)), depth);
    s.normal = octahedral_decode(texelFetch(normal_layer, pixel, 0).rg);
    s.to_eye = normalize(frame.eye - s.position);
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
        attenuation *= shadow_of(light, s.position, s.normal, to_light, facing, push.shadow_size, push.shadow_radius);
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
        surface s = read_surface(pixel, depth);
        radiance = texelFetch(emissive_layer, pixel, 0).rgb;
        for (uint i = 0; i < frame.light_count; i++) radiance += reflected(s, frame_light_table[i]);
    }
    imageStore(direct_layer, pixel, vec4(min(radiance, vec3(HALF_MAX)), 1.0));
}
