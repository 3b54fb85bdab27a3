// Direct light at a path vertex from punctual lights and emitters. *rays counts traced rays.
#pragma once

#include "trace/guided_bsdf.h"
#include "trace/surface.h"

// Irradiance at a surface, lux, and the radiance reflected back along the path, cd/m².
struct arriving_light {
    vec3s irradiance, radiance;
};

// Reflected radiance of all punctual lights, without randomness.
vec3s next_event_all_punctual(const struct trace_scene *scene, const struct surface *surface,
                              const struct bsdf *bsdf, uint64_t *rays);
// Estimate from one light, selected by its unoccluded contribution. choice: from the unit interval.
struct arriving_light next_event_one_punctual(const struct trace_scene *scene,
                                              const struct surface *surface,
                                              const struct bsdf *bsdf, float choice,
                                              uint64_t *rays);
// Estimate from a point on an emitter, weighted against that many samples of directions.
struct arriving_light next_event_one_emitter(const struct trace_scene *scene,
                                             const struct surface *surface,
                                             const struct guided_bsdf *bsdf, float choice, vec2s u,
                                             float directions, uint64_t *rays);
// Estimate from a direction to the map of the environment, likewise.
struct arriving_light next_event_environment(const struct trace_scene *scene,
                                             const struct surface *surface,
                                             const struct guided_bsdf *bsdf, vec2s u,
                                             float directions, uint64_t *rays);
// Radiance arriving from a direction with BSDF value f. scale: cosine over pdf, times the weight.
static inline struct arriving_light light_arriving(vec3s f, vec3s radiance, float scale)
{
    struct arriving_light g = { .irradiance = glms_vec3_scale(radiance, scale) };
    g.radiance = glms_vec3_mul(f, g.irradiance);
    return g;
}

// Power heuristic with exponent 2 for a sample of density `pdf` against the other strategy's
// `other`. Computed from the ratio to avoid overflow.
static inline float power_heuristic(float pdf, float other)
{
    float ratio = other / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}
static inline bool is_black(vec3s v)
{
    return !(v.x > 0.0f || v.y > 0.0f || v.z > 0.0f);
}
