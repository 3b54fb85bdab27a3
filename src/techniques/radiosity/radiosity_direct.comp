// Light that texels reflect before any bounce: of all lights, with shadows, of emissive surfaces
// and of the sky. In scaled lumen: radiosity times area.
//
// A texel stands for its area A. A light of intensity I at distance d → 0 lights a wall by I/d²,
// but sends it 2πI only: with d² + A/2π, a texel never receives more than that flux.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define SHADOW_FACES_BINDING     2
#define SHADOW_MAPS_BINDING      3
#define SHADOW_SUN_MAPS_BINDING  12
#define RADIOSITY_TEXELS_BINDING 4
#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
#include "techniques/radiosity/radiosity_texels.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_direct_push push;
};
layout(set = 0, binding = 5, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};
layout(set = 0, binding = 6, scalar) writeonly buffer radiosity_flux
{
    vec3 flux_table[];
};

const float PI = 3.14159265;

vec3 irradiance_of(radiosity_gpu_texel texel, frame_light light)
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
                                         push.shadow_radius);
    return light.intensity * (attenuation * cosine);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    radiosity_gpu_texel texel = texel_table[i];
    vec3 irradiance = vec3(0.0);
    if (texel.area_m2 > 0.0) {
        for (int c = 0; c < 3; c++)
            irradiance[c] =
                radiosity_unbounced(texel, c, frame.sky, push.emitters * frame.radiance_scale).x;
        for (uint k = 0; k < frame.light_count; k++)
            irradiance += irradiance_of(texel, frame_light_table[k]);
    }
    flux_table[i] = texel.area_m2 * texel.reflectance * irradiance;
}
