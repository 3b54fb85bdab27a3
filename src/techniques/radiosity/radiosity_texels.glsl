// The table of texels.
#ifndef AG_RADIOSITY_TEXELS_GLSL
#define AG_RADIOSITY_TEXELS_GLSL

#include "techniques/radiosity/radiosity_shared.h"

layout(set = 0, binding = RADIOSITY_TEXELS_BINDING, scalar) readonly buffer radiosity_texels
{
    radiosity_gpu_texel texel_table[];
};

// Irradiance and vector irradiance of the sky and of emissive surfaces, by colour. xyz of a column
// pair are not normalised: x is the irradiance, yzw the vector.
vec4 radiosity_unbounced(radiosity_gpu_texel texel, int colour, vec3 sky, float emitters)
{
    return texel.sky * sky[colour] + texel.emitted[colour] * emitters;
}

#endif
