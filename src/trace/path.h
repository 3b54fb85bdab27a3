// Paths from the eye: what one sample of a pixel sees.
#pragma once

#include "trace/surface.h"

// What all paths of a picture share.
struct path_rules {
    const struct trace_scene *scene;
    int bounces; // -1: until chance ends a path
    bool direct, indirect, diffuse_only;
    uint32_t seed;
};

// What all samples through one point of a pixel share: the surface there and the light on it that needs no chance.
struct path_start {
    bool hit;
    struct surface surface;
    struct bsdf bsdf;
    vec3s seen; // cd/m²: the sky, or emission and the reflection of punctual lights; 0 where not wanted
};

// Radiance towards the eye, cd/m², and irradiance, lux. Gathered is indirect light and what emitters and the sky throw
// straight on the surface seen.
struct path_light {
    vec3s direct, indirect, gathered;
    vec3s irradiance, gathered_irradiance; // by indirect and by gathered light
};

// The ray passes through backs of single-sided surfaces. *rays counts.
struct path_start path_begin(const struct path_rules *rules, const struct ray *ray,
                             const struct pixel_footprint *footprint, uint64_t *rays);
// Sample number `sample` of pixel `pixel`: the same arguments give the same light.
struct path_light path_sample(const struct path_rules *rules, const struct path_start *start,
                              uint32_t pixel, uint32_t sample, uint64_t *rays);
