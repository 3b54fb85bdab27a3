// Light of a texel before any bounce: irradiance of emissive surfaces and the sky, which the
// frame's direct light lacks, and of all lights, with shadows.
#ifndef AG_MRT_DIRECT_GLSL
#define AG_MRT_DIRECT_GLSL

#define SHADOW_FACES_BINDING    2
#define SHADOW_MAPS_BINDING     3
#define SHADOW_SUN_MAPS_BINDING 12
#define MRT_TEXELS_BINDING      4
#include "frame/frame.glsl"
#include "frame/environment.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
#include "techniques/common/texel_light.glsl"
#include "techniques/mrt/gpu/level.glsl"

layout(set = 0, binding = 5, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};

// Light of emissive surfaces, and a share of that of the environment.
vec3 area_light_of(vec3 emitted, vec3 share, vec3 environment)
{
    return emitted * (frame.radiance_scale * level.emitters) + share * environment;
}

void add_lights(mrt_texel texel, inout vec3 irradiance)
{
    for (uint k = 0; k < frame.light_count; k++)
        irradiance += texel_irradiance(texel.position, texel.normal, texel.normal, texel.area_m2,
                                       frame_light_table[k], level.shadow_radius);
}

#endif
