// Light that texels reflect before any bounce: of all lights, with shadows, of emissive surfaces
// and of the sky. In scaled lumen: radiosity times area.
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
#include "techniques/common/texel_light.glsl"
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
            irradiance += texel_irradiance(texel.position, texel.normal, texel.area_m2,
                                           frame_light_table[k], push.shadow_radius);
    }
    flux_table[i] = texel.area_m2 * texel.reflectance * irradiance;
}
