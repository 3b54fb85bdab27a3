// Warps of the unit square to directions and surfaces. Densities are per solid angle (sr⁻¹).
#pragma once

#include "core/vec.h"

#include <math.h>

vec3s sample_sphere(vec2s u);                          // uniform, density 1/(4π)
static inline vec3s sample_hemisphere_cosine(vec2s u); // around +z, density cosθ/π
vec3s sample_hemisphere_uniform(vec2s u);              // around +z, density 1/(2π)
// Point `index` mod `count` of the first `count` points of the Halton sequence of bases 2 and 3,
// moved so that their mean is 0; in −½…½. (0, 0) for a count below 2.
vec2s sample_jitter(int index, int count);
static inline vec2s sample_disk(vec2s u);     // concentric (Shirley & Chiu 1997), unit disk
vec2s sample_disk_inverse(vec2s disk);        // the point of the unit square
static inline vec2s sample_triangle(vec2s u); // barycentric b1, b2, uniform by area

// ---- inline, for the path tracer

// cos x and sin x for |x| ≤ π/4 by their Taylor series, to float precision; the C library's
// functions spend time on range reduction.
static inline vec2s small_cos_sin(float x)
{
    float s = x * x;
    return (vec2s){
        { 1.0f - s * (1.0f / 2 - s * (1.0f / 24 - s * (1.0f / 720 - s * (1.0f / 40320)))),
          x * (1.0f - s * (1.0f / 6 - s * (1.0f / 120 - s * (1.0f / 5040 - s * (1.0f / 362880))))) }
    };
}

static inline vec2s sample_disk(vec2s u)
{
    float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f;
    if (x == 0.0f && y == 0.0f) return (vec2s){ { 0.0f, 0.0f } };
    bool wide = fabsf(x) > fabsf(y);
    float radius = wide ? x : y;
    // The angle is π/4 · y/x from the x axis, or π/4 · x/y from the y axis.
    vec2s unit = small_cos_sin(GLM_PIf / 4.0f * (wide ? y / x : x / y));
    return (vec2s){ { radius * (wide ? unit.x : unit.y), radius * (wide ? unit.y : unit.x) } };
}

// Heitz 2019, "A Low-Distortion Map Between Triangle and Square": preserves area, and unlike the
// square-root map keeps neighbouring points close.
static inline vec2s sample_triangle(vec2s u)
{
    float half = 0.5f * (u.x < u.y ? u.x : u.y);
    return (vec2s){ { u.x - half, u.y - half } };
}

// Malley's method: a uniform disk sample projected up to the hemisphere.
static inline vec3s sample_hemisphere_cosine(vec2s u)
{
    vec2s d = sample_disk(u);
    float rest = 1.0f - d.x * d.x - d.y * d.y;
    return vec3_of(d.x, d.y, sqrtf(rest > 0.0f ? rest : 0.0f));
}
