// The table of texels (texels.h).
#ifndef AG_LIGHT_MAP_TEXELS_GLSL
#define AG_LIGHT_MAP_TEXELS_GLSL

#include "frame/environment.glsl"
#include "techniques/common/light_map/table.glsl"

layout(set = 0, binding = LIGHT_MAP_TEXELS_BINDING,
       rgba32f) uniform readonly image2D light_map_texels;

vec4 light_map_texel_part(uint texel, uint texels, int part)
{
    return imageLoad(light_map_texels, light_map_at(part * texels + texel));
}

// Irradiance x and vector irradiance yzw of a colour, of the sky and of emissive surfaces.
// emitters: 1, or 0: these are no sources.
vec4 light_map_unbounced(uint texel, uint texels, int colour, float emitters)
{
    return light_map_texel_part(texel, texels, TEXEL_SKY_LIGHT) * environment_mean()[colour] +
           light_map_texel_part(texel, texels, TEXEL_EMITTED_0 + colour) *
               (emitters * frame.radiance_scale);
}

#endif
