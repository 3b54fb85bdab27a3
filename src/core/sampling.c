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

vec2s sample_disk_inverse(vec2s disk)
{
    const bool wide = fabsf(disk.x) > fabsf(disk.y);
    const float along = wide ? disk.x : disk.y, across = wide ? disk.y : disk.x;
    if (along == 0.0f) return (vec2s){ { 0.5f, 0.5f } };
    const float radius = copysignf(glms_vec2_norm(disk), along);
    const float other = radius * atanf(across / along) * (4.0f / GLM_PIf);
    const vec2s square = { { wide ? radius : other, wide ? other : radius } };
    return (vec2s){ { 0.5f + 0.5f * square.x, 0.5f + 0.5f * square.y } };
}

// Digits of an index mirrored at the radix point.
static double radical_inverse(int index, int base)
{
    double sum = 0.0, digit = 1.0 / base;
    for (; index > 0; index /= base, digit /= base) sum += index % base * digit;
    return sum;
}

// Point 0 of the sequence is left out: it is a corner.
vec2s sample_jitter(int index, int count)
{
    if (count < 2) return (vec2s){ { 0.0f, 0.0f } };
    index = (index % count + count) % count;
    double x = 0.0, y = 0.0;
    for (int i = 1; i <= count; i++) {
        x += radical_inverse(i, 2);
        y += radical_inverse(i, 3);
    }
    x = radical_inverse(index + 1, 2) - x / count;
    y = radical_inverse(index + 1, 3) - y / count;
    // Few counts exceed it, by a thousandth.
    return (vec2s){ { (float)fmax(fmin(x, 0.5), -0.5), (float)fmax(fmin(y, 0.5), -0.5) } };
}
