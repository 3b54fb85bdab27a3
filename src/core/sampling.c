// Warps of the unit square.
#include "core/sampling.h"

#include <math.h>

// A direction around +z from 1 − cosθ (0…2) and φ / 2π.
static vec3s direction_of(float one_minus_cos, float turns)
{
    float sin_theta = sqrtf(fmaxf(0.0f, one_minus_cos * (2.0f - one_minus_cos)));
    float phi = 2.0f * GLM_PIf * turns;
    return vec3_of(sin_theta * cosf(phi), sin_theta * sinf(phi), 1.0f - one_minus_cos);
}

vec3s sample_sphere(vec2s u)
{
    return direction_of(2.0f * u.x, u.y);
}

vec3s sample_hemisphere_uniform(vec2s u)
{
    return direction_of(u.x, u.y);
}
