// The table of texels.
#ifndef AG_RADIOSITY_TEXELS_GLSL
#define AG_RADIOSITY_TEXELS_GLSL

#include "techniques/common/light_map/table.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(set = 0, binding = RADIOSITY_TEXELS_BINDING,
       rgba32f) uniform readonly image2D radiosity_texels;

vec4 radiosity_texel_part(uint texel, uint texels, int part)
{
    return imageLoad(radiosity_texels, light_map_at(part * texels + texel));
}

// Irradiance and vector irradiance of the sky and of emissive surfaces, by colour. xyz of a column
// pair are not normalised: x is the irradiance, yzw the vector.
vec4 radiosity_unbounced(uint texel, uint texels, int colour, vec3 sky, float emitters)
{
    return radiosity_texel_part(texel, texels, RADIOSITY_SKY_LIGHT) * sky[colour] +
           radiosity_texel_part(texel, texels, RADIOSITY_EMITTED_0 + colour) * emitters;
}

#endif
