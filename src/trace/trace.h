// Rays through a scene on the CPU, and the reference: a path tracer with the materials, lights,
// camera and units of the real-time frame (docs/units.md), to hold all techniques against. The only
// header of this module that others include.
//
// What a ray meets is what the frame draws: rays from the camera pass through the backs of
// single-sided surfaces; for all other rays, as in shadow maps, surfaces have two sides, and the
// back of a single-sided one reflects as its front does but does not glow. Masked surfaces are met
// where they are opaque.
#pragma once

#include "image/image.h"
#include "scene/pose.h"

// ---- Rays ---------------------------------------------------------------------------------------

// A scene at a moment as triangles in world space, with their materials and lights. Copies what the
// pose has; the scene itself must outlive it. Rays may come from many threads at a time.
struct trace_scene;

// What the scene's lights and sky are is read here. NULL on failure.
struct trace_scene *trace_scene_create(struct host *host, const struct scene_pose *pose);
void trace_scene_destroy(struct trace_scene *scene); // accepts NULL

struct trace_hit {
    float distance; // in lengths of the ray's direction
    int instance;
    uint32_t triangle;
    float u, v;      // of the triangle's second and third corner
    vec3s position;  // m
    vec3s geometric; // unit normal of the triangle's front
    vec3s normal;    // unit shading normal on the side that the ray comes from
    bool front;      // the ray comes from the front
    vec3s albedo;    // base colour, 0…1
    float metallic, roughness;
    vec3s emission; // towards the ray's origin, cd/m²
    float reach_m;  // how far trace_leave goes
};

// The nearest surface, front or back. `direction` need not be unit. hit may be NULL.
bool trace_closest(const struct trace_scene *scene, vec3s origin, vec3s direction,
                   float max_distance, struct trace_hit *hit);
bool trace_occluded(const struct trace_scene *scene, vec3s origin, vec3s direction,
                    float max_distance);
// A point moved off the surface on the side of `direction`, so that a ray from there does not meet
// the surface again.
vec3s trace_leave(const struct trace_hit *hit, vec3s direction);

// ---- Reference ----------------------------------------------------------------------------------

struct reference_options {
    int bounces; // of indirect light: 0 direct light alone, 1 one bounce, …; -1: until chance ends
                 // a path
    bool direct_only;          // color holds direct light alone
    bool indirect_only;        // color holds indirect light alone
    bool diffuse_only;         // surfaces do not gloss: Lambert's term alone
    bool antialias;            // samples all over the pixel; false: at its centre, as in the frame
    float obscurance_radius_m; // of the layers obscurance and ambient_occlusion: > 0
    float occlusion_decay_per_m; // of ambient_occlusion with the distance (obscurance.c); ≥ 0
    bool obscurance_sphere;      // obscurance of the whole sphere, else of the hemisphere above the
                                 // surface
    uint64_t seed;
};
struct reference_options
reference_options_default(void); // bounces -1, radius 0.5 m, seed 0, all else off

enum reference_layer {
    REFERENCE_COLOR,  // cd/m²: direct + indirect, to the bit
    REFERENCE_DIRECT, // cd/m²: emission and sky as seen, and what is reflected of light that comes
                      // straight from a light, an emitter or the sky
    REFERENCE_INDIRECT,              // cd/m²: the rest
    REFERENCE_INDIRECT_EMITTERS_SKY, // cd/m²: indirect light, and what emitters and the sky throw
                                     // straight on the surface seen: all that techniques add to the
                                     // frame's direct light. With direct_only the latter alone,
                                     // with indirect_only the former
    REFERENCE_IRRADIANCE,              // lux: of the indirect light; 0 with direct_only
    REFERENCE_IRRADIANCE_EMITTERS_SKY, // lux: of that light, as a technique's irradiance
    REFERENCE_ALBEDO,   // of the pixel's centre, as all from here on but error and samples
    REFERENCE_NORMAL,   // shading normal, world space; 0 where there is no surface, as are the next
                        // two
    REFERENCE_DEPTH,    // m along the view axis; 1 channel
    REFERENCE_POSITION, // m
    REFERENCE_ERROR,    // standard error of color, per channel, cd/m²; infinite for less than 2
                        // samples
    REFERENCE_SAMPLES,  // how many there are so far; 1 channel
    REFERENCE_OBSCURANCE, // open share of the volume of a (hemi)sphere round the pixel's centre
                          // (obscurance.c); 1 channel
    REFERENCE_AMBIENT_OCCLUSION, // open share of the sky up to that radius, by the cosine, and by
                                 // the decay; 1 channel; both 1 where there is no surface, from as
                                 // many rays as there are samples
    REFERENCE_LAYER_COUNT
};
const char *reference_layer_name(int layer); // "color", …; NULL out of range

struct reference;

// Progressive: starts without samples. width, height: 1…IMAGE_MAX_SIZE. NULL on failure.
struct reference *reference_create(struct host *host, const struct scene_pose *pose,
                                   const struct world_camera *camera, int width, int height,
                                   const struct reference_options *options);
void reference_destroy(struct reference *reference); // accepts NULL

// Adds `samples` to every pixel, on all cores. The result depends neither on their number nor on
// how the samples are spread over calls. `progress` (may be NULL) is called on this thread now and
// then with the share that is done, 0…1; when it returns false the work stops, with FAIL_CANCELLED,
// and what is there stays: some pixels then have more samples than others, and the next call evens
// that out.
bool reference_render(struct reference *reference, int samples,
                      bool (*progress)(void *user, double done), void *user);

struct reference_info {
    int samples;   // of every pixel: the least
    uint64_t rays; // traced so far
    double mean;   // mean luminance of color, cd/m²
    double error;  // root mean square over the pixels of the luminance's standard error, cd/m²
};
struct reference_info reference_info(const struct reference *reference);

// From now on all rays are put down in the log (trace/embree.h); NULL: no longer.
struct ray_log;
void reference_log_rays(struct reference *reference, struct ray_log *log);

// A new image of 3 channels (1 where said so above); image_finish is the caller's.
bool reference_read(struct reference *reference, enum reference_layer layer, struct image *out);

// What identifies the picture being computed: scene, light, camera, size and options. Two
// references with equal keys converge to the same values through the same samples.
uint64_t reference_key(const struct reference *reference);
// The layers to go on from later.
enum reference_kept {
    KEPT_DIRECT,
    KEPT_INDIRECT,
    KEPT_INDIRECT_EMITTERS_SKY,
    KEPT_IRRADIANCE,
    KEPT_IRRADIANCE_EMITTERS_SKY,
    KEPT_ERROR,
    KEPT_SAMPLES,
    REFERENCE_KEPT_COUNT
};
extern const enum reference_layer reference_kept_layers[REFERENCE_KEPT_COUNT];
// Goes on from these layers of an earlier run with the same key. They have 32-bit floats, sums have
// 64: the result is the uninterrupted one's but for rounding.
bool reference_restore(struct reference *reference,
                       const struct image layers[REFERENCE_KEPT_COUNT]);
