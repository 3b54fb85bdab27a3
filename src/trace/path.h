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

// What all samples through one point of a pixel share: the surface there and the light on it that
// needs no chance.
struct path_start {
    bool hit;
    struct surface surface;
    struct bsdf bsdf;
    vec3s seen; // cd/m²: the sky, or emission and the reflection of punctual lights; 0 where not
                // wanted
};

// Radiance towards the eye, cd/m², and irradiance, lux. Gathered is indirect light and what
// emitters and the sky throw straight on the surface seen.
struct path_light {
    vec3s direct, indirect, indirect_emitters_sky;
    vec3s irradiance, irradiance_emitters_sky; // lux, of the same light
};

// Where in its pixel a sample is, 0…1 each way.
vec2s path_place(const struct path_rules *rules, uint32_t pixel, uint32_t sample);

// The ray passes through backs of single-sided surfaces. *rays counts.
struct path_start path_begin(const struct path_rules *rules, const struct ray *ray,
                             const struct pixel_footprint *footprint, uint64_t *rays);

// One sample of a pixel, and the light that it brings: the same arguments bring the same.
struct path_sample {
    const struct path_start *start;
    uint32_t pixel, sample;
    struct path_light light;
};
enum { PATH_BATCH = 64 };
// At most PATH_BATCH at a time. They go step by step together: what one needs from memory is on its
// way while others compute.
void path_trace(const struct path_rules *rules, struct path_sample *samples, int count,
                uint64_t *rays);
