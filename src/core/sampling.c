// Warps of the unit square. Sines are computed from 1 − cosθ: in narrow cones 1 − cos²θ would lose
// its digits to cancellation.
#include "core/sampling.h"

#include <math.h>

static const float PI = 3.14159265358979f;

// A direction around +z from 1 − cosθ (0…2) and φ / 2π.
static vec3s direction_of(float one_minus_cos, float turns)
{
    float sin_theta = sqrtf(fmaxf(0.0f, one_minus_cos * (2.0f - one_minus_cos)));
    float phi = 2.0f * PI * turns;
    return vec3_of(sin_theta * cosf(phi), sin_theta * sinf(phi), 1.0f - one_minus_cos);
}

vec3s sample_sphere(vec2s u)
{
    return direction_of(2.0f * u.x, u.y);
}

float pdf_sphere(void)
{
    return 1.0f / (4.0f * PI);
}

float pdf_hemisphere_cosine(float cos_theta)
{
    return fmaxf(0.0f, cos_theta) / PI;
}

vec3s sample_hemisphere_uniform(vec2s u)
{
    return direction_of(u.x, u.y);
}

float pdf_hemisphere_uniform(void)
{
    return 1.0f / (2.0f * PI);
}

vec3s sample_cone_uniform(vec2s u, float cos_max)
{
    return direction_of(u.x * (1.0f - cos_max), u.y);
}

float pdf_cone_uniform(float cos_max)
{
    return 1.0f / (2.0f * PI * (1.0f - cos_max));
}
