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

// Irradiance x and vector irradiance yzw of a colour, as of light from all directions.
vec4 light_map_painted_of(uint texel, uint texels, int colour)
{
    float lux = imageLoad(light_map_paint, light_map_at(texel))[colour];
    vec3 normal = light_map_texel_part(texel, texels, TEXEL_NORMAL).xyz;
    return min(lux * frame.radiance_scale, HALF_MAX) * vec4(1.0, normal);
}

// The same of the sky, emissive surfaces and paint.
vec4 light_map_unbounced(uint texel, uint texels, int colour, light_map_sources sources)
{
    vec4 light = light_map_texel_part(texel, texels, TEXEL_SKY_LIGHT) * environment_mean()[colour] +
                 light_map_texel_part(texel, texels, TEXEL_EMITTED_0 + colour) *
                     (sources.emitters * frame.radiance_scale);
    if (sources.painted != 0u) light += light_map_painted_of(texel, texels, colour);
    return light;
}

#endif
