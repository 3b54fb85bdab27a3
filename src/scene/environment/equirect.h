// Equirectangular images: the top row is +y, the centre of the image −z, and columns grow towards
// +x:
//     u = ½ + atan2(x, −z) / 2π, v = acos(y) / π.
#pragma once

#include "core/vec.h"

#include <math.h>

// The unit direction at (u, v).
static inline vec3s equirect_direction(vec2s uv)
{
    const float azimuth = (uv.x - 0.5f) * 2.0f * GLM_PIf, polar = uv.y * GLM_PIf;
    return vec3_of(sinf(polar) * sinf(azimuth), cosf(polar), -sinf(polar) * cosf(azimuth));
}

static inline vec2s equirect_uv(vec3s unit)
{
    const float u = 0.5f + atan2f(unit.x, -unit.z) * (0.5f / GLM_PIf);
    return (vec2s){ { u, acosf(fminf(fmaxf(unit.y, -1.0f), 1.0f)) / GLM_PIf } };
}

// (u, v) of the middle of a texel.
static inline vec2s equirect_texel_uv(int width, int height, int x, int y)
{
    return (vec2s){ { ((float)x + 0.5f) / (float)width, ((float)y + 0.5f) / (float)height } };
}

// Solid angle of a texel of row y, sr.
static inline double equirect_solid_angle(int width, int height, int y)
{
    const double step = GLM_PI / height;
    const double strip = 2.0 * sin((y + 0.5) * step) * sin(0.5 * step); // cos(top) − cos(bottom)
    return 2.0 * GLM_PI / width * strip;
}
