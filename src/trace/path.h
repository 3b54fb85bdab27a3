// Camera paths: the radiance samples of a pixel.
#pragma once

#include "trace/guide.h"
#include "trace/surface.h"

// Settings of all paths of an image.
struct path_settings {
    const struct trace_scene *scene;
    const struct guide *guide; // NULL: no guided rays
    int bounces;               // -1: unlimited, ended by Russian roulette
    bool direct, indirect, diffuse_only;
    // Samples of a pixel, from 0, share points of a Sobol sequence at the primary hit. Less
    // variance, but the samples are not independent: their variance gives no standard error.
    bool stratified;
    // Least roughness of lobes that reflect punctual lights at later hits, which sampled directions
    // never meet (path regularisation, Kaplanyan & Dachsbacher 2013). 0: none, without bias.
    float min_punctual_roughness;
    uint32_t seed;
};

// The primary hit and its deterministic light, shared by all samples through one point of a pixel.
struct path_start {
    bool hit;
    struct surface surface;
    struct bsdf bsdf;
    vec3s radiance; // cd/m²: sky, or emission plus reflected punctual light; 0 without direct light
};

// Radiance towards the camera, cd/m², and irradiance at the primary hit, lux. With emitters_sky:
// indirect light plus direct light of emitters and the sky.
struct path_light {
    vec3s direct, indirect, indirect_emitters_sky;
    vec3s irradiance, irradiance_emitters_sky;
};

// Radiance of the environment along a direction that was sampled with density `pdf`, 1/sr: that of
// its map is weighted against next-event estimation.
vec3s path_environment(const struct trace_scene *scene, vec3s direction, float pdf);

// Position of a sample within its pixel, 0…1.
vec2s path_subpixel(const struct path_settings *settings, uint32_t pixel, uint32_t sample);

// The ray passes through back faces of single-sided surfaces. *rays counts traced rays.
struct path_start path_begin(const struct path_settings *settings, const struct ray *ray,
                             const struct pixel_footprint *footprint, uint64_t *rays);

// The first vertices of a path, to learn from. Such paths end with the trail, not by Russian
// roulette.
enum { PATH_TRAIL = 8 };
struct path_vertex {
    vec3s position, normal;
    float throughput;    // luminance, of the path before
    vec3s direction;     // sampled
    float cosine;        // of the direction; 0: the path ended here
    vec3s f;             // BSDF, 1/sr
    float bsdf_pdf, pdf; // of BSDF sampling; of the sample; 1/sr
    float share;         // of guided samples where the cell's weight is 1
    vec3s direct;        // next-event estimate reflected here, cd/m²
    vec3s light;         // emission and direct light at the end of the step, cd/m²
};
struct path_trail {
    struct path_vertex vertices[PATH_TRAIL];
    int count;
};

// The end of a path's first step and the light that it reflects, for receivers that share it
// (share.h). Its first direction is of a sequence that the paths of several pixels may share.
struct path_end {
    uint32_t pixel, sample; // of that sequence: arguments
    float directions;       // samples that next-event estimation is weighted against: argument
    bool sampled;           // the path has a first step
    bool hit;               // false: the environment
    vec3s direction;        // of the step, unit
    struct surface surface; // where hit
    vec3s irradiance;       // of the surface, lux
    vec3s rest;             // reflected by other lobes than the diffuse one, cd/m²
};

// One sample of a pixel and its result, a function of the arguments alone.
struct path_sample {
    const struct path_start *start;
    uint32_t pixel, sample;
    struct path_light light;
    struct path_trail *trail; // NULL: not recorded
    // NULL, or takes the light that arrives along the first step: `light` is then without it.
    struct path_end *end;
};
enum { PATH_BATCH = 64 };
// count: at most PATH_BATCH. The paths advance in lockstep, so that memory is prefetched for one
// while others compute.
void path_trace(const struct path_settings *settings, struct path_sample *samples, int count,
                uint64_t *rays);
