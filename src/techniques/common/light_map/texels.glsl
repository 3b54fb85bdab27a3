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

// Irradiance x and vector irradiance yzw of a colour, of the sky and of emissive surfaces.
vec4 light_map_unbounced(uint texel, uint texels, int colour, light_map_sources sources)
{
    return light_map_texel_part(texel, texels, TEXEL_SKY_LIGHT) * environment_mean()[colour] +
           light_map_texel_part(texel, texels, TEXEL_EMITTED_0 + colour) *
               (sources.emitters * frame.radiance_scale);
}

// Irradiance of paint, whose vector irradiance is along the normal.
vec3 light_map_painted_light(uint texel, light_map_sources sources)
{
    if (sources.painted == 0u) return vec3(0.0);
    vec3 lux = imageLoad(light_map_paint, light_map_at(texel)).rgb;
    return min(lux * frame.radiance_scale, vec3(HALF_MAX));
}

#endif
