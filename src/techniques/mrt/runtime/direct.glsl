// Light of a texel before any bounce: irradiance of emissive surfaces and the sky, which the
// frame's direct light lacks, and of all lights, with shadows.
//
// A texel stands for its area A. A light of intensity I at distance d → 0 lights a wall by I/d²,
// but sends it 2πI only: with d² + A/2π, a texel never receives more than that flux.
#ifndef AG_MRT_DIRECT_GLSL
#define AG_MRT_DIRECT_GLSL

#define SHADOW_FACES_BINDING    2
#define SHADOW_MAPS_BINDING     3
#define SHADOW_SUN_MAPS_BINDING 12
#define MRT_TEXELS_BINDING      4
#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
#include "techniques/mrt/runtime/level.glsl"

layout(set = 0, binding = 5, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};
layout(set = 0, binding = 6, scalar) writeonly buffer mrt_unbounced
{
    vec3 unbounced_table[]; // irradiance of emissive surfaces and the sky
};
const float PI = 3.14159265;

vec3 irradiance_of(mrt_texel texel, frame_light light)
{
    vec3 to_light = -light.direction;
    float attenuation = 1.0;
    if (light.type != FRAME_LIGHT_SUN) {
        to_light = light.position - texel.position;
        float distance2 = dot(to_light, to_light);
        to_light *= inversesqrt(max(distance2, 1e-12));
        attenuation = light_cone(light, -to_light) * light_window(light, distance2) /
                      (distance2 + texel.area_m2 / (2.0 * PI));
    }
    float cosine = dot(texel.normal, to_light);
    if (cosine <= 0.0 || attenuation <= 0.0) return vec3(0.0);
    if (light.shadow_first >= 0)
        attenuation *= shadow_visibility(light, texel.position, texel.normal, to_light, true,
                                         level.shadow_radius);
    return light.intensity * (attenuation * cosine);
}

vec3 unbounced_of(mrt_texel texel)
{
    vec3 unbounced = texel.emitted * (frame.radiance_scale * level.emitters);
    return unbounced + PI * texel.sky * frame.sky;
}

void add_lights(mrt_texel texel, inout vec3 irradiance)
{
    for (uint k = 0; k < frame.light_count; k++)
        irradiance += irradiance_of(texel, frame_light_table[k]);
}

#endif
