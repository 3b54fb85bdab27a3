// Light that falls on a surface straight from lights and emitters, as a path asks for it. *rays
// counts.
#pragma once

#include "trace/surface.h"

// Light on a surface, lux, and what of it goes on towards where the path came from, cd/m².
struct gathered {
    vec3s irradiance, radiance;
};

// Of all punctual lights, no chance involved.
vec3s gather_all_punctual(const struct trace_scene *scene, const struct surface *surface,
                          const struct bsdf *bsdf, uint64_t *rays);
// One light, chosen by what it would give, stands for all. choice: from the unit interval.
vec3s gather_one_punctual(const struct trace_scene *scene, const struct surface *surface,
                          const struct bsdf *bsdf, float choice, uint64_t *rays);
// A point on an emitter, weighted against meeting it by the surface's own sampling.
struct gathered gather_one_emitter(const struct trace_scene *scene, const struct surface *surface,
                                   const struct bsdf *bsdf, float choice, vec2s u, uint64_t *rays);
// Radiance from a direction with the reflection f; scale: the direction's cosine over its density,
// times its weight.
static inline struct gathered gather_arriving(vec3s f, vec3s radiance, float scale)
{
    struct gathered g = { .irradiance = glms_vec3_scale(radiance, scale) };
    g.radiance = glms_vec3_mul(f, g.irradiance);
    return g;
}

// The power heuristic with an exponent of 2 for what was found with density `pdf` and could have
// been with `other`. A ratio, so that nothing overflows.
static inline float gather_weight(float pdf, float other)
{
    float ratio = other / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}
static inline bool gather_is_black(vec3s v)
{
    return !(v.x > 0.0f || v.y > 0.0f || v.z > 0.0f);
}
