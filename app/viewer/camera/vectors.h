// Vectors of three floats.
#pragma once

#include <math.h>

static inline float vec_dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline float vec_length(const float v[3])
{
    return sqrtf(vec_dot(v, v));
}

// Zero stays.
static inline void vec_normalize(float v[3])
{
    const float length = vec_length(v);
    for (int i = 0; i < 3 && length > 0; i++) v[i] /= length;
}

static inline void vec_cross(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

// from + distance · direction
static inline void vec_along(const float from[3], float distance, const float direction[3],
                             float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = from[i] + distance * direction[i];
}
