// The table of texels (texels.h) and of their painted light (paint.h).
#ifndef AG_LIGHT_MAP_TEXELS_GLSL
#define AG_LIGHT_MAP_TEXELS_GLSL

#include "frame/environment.glsl"
#include "techniques/common/light_map/table.glsl"

layout(set = 0, binding = LIGHT_MAP_TEXELS_BINDING,
       rgba32f) uniform readonly image2D light_map_texels;
layout(set = 0, binding = LIGHT_MAP_PAINT_BINDING,
       rgba32f) uniform readonly image2D light_map_paint; // [texel] lux

vec4 light_map_texel_part(uint texel, uint texels, int part)
{
    return imageLoad(light_map_texels, light_map_at(part * texels + texel));
}

// Adds irradiance x and vector irradiance yzw of the environment, by colour. The vector irradiance
// has the direction of that of a uniform sky.
void light_map_add_sky(uint texel, uint texels, inout vec4 light[3])
{
    if (environment_mean() == vec3(0.0)) return;
    vec4 a = light_map_texel_part(texel, texels, TEXEL_SKY_0),
         b = light_map_texel_part(texel, texels, TEXEL_SKY_0 + 1),
         c = light_map_texel_part(texel, texels, TEXEL_SKY_0 + 2);
    if (a.x <= 0.0) return;
    float transfer[9] = float[9](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x);
    vec3 irradiance = environment_irradiance(transfer);
    vec3 along = c.yzw / (a.x * sqrt(4.0 * PI)); // over the irradiance of radiance 1
    for (int k = 0; k < 3; k++) light[k] += irradiance[k] * vec4(1.0, along);
}

// Irradiance x and vector irradiance yzw of the environment and of emissive surfaces, by colour.
vec4[3] light_map_unbounced(uint texel, uint texels, light_map_sources sources)
{
    vec4 light[3];
    for (int c = 0; c < 3; c++)
        light[c] = light_map_texel_part(texel, texels, TEXEL_EMITTED_0 + c) *
                   (sources.emitters * frame.radiance_scale);
    light_map_add_sky(texel, texels, light);
    return light;
}

// Irradiance of paint, whose vector irradiance is along the normal.
vec3 light_map_painted_light(uint texel, light_map_sources sources)
{
    if (sources.painted == 0u) return vec3(0.0);
    vec3 lux = imageLoad(light_map_paint, light_map_at(texel)).rgb;
    return min(lux * frame.radiance_scale, vec3(HALF_MAX));
}

#endif
