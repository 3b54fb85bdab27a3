// CPU ray queries, and the reference: a path tracer with the materials, lights, camera and units of
// the real-time frame (docs/units.md), the ground truth of all techniques. The only public header
// of this module.
//
// Visibility equals the frame's: camera rays pass through back faces of single-sided surfaces. All
// other rays hit both sides, as shadow maps do; the back face of a single-sided surface reflects as
// the front but does not emit. Alpha-masked surfaces are hit where they are opaque.
#pragma once

#include "image/image.h"
#include "scene/pose.h"

// ---- Rays ---------------------------------------------------------------------------------------

// World-space triangles, materials and lights of a posed scene. Copies the pose; the scene must
// outlive it. Queries are thread-safe.
struct trace_scene;

// Reads the lights and sky of the scene once. NULL on failure.
struct trace_scene *trace_scene_create(struct host *host, const struct scene_pose *pose);
void trace_scene_destroy(struct trace_scene *scene); // accepts NULL

// Memory of a triangle of a scene, about: Embree's hierarchy (its quads take some 120 bytes for
// each triangle), corners and facets.
enum { TRACE_TRIANGLE_BYTES = 240 };

struct trace_hit {
    float distance; // in units of the direction's length
    int instance;
    uint32_t triangle;
    float u, v;      // barycentric weights of the second and third corner
    vec3s position;  // m
    vec3s geometric; // unit normal of the front face
    vec3s normal;    // unit shading normal facing the ray origin
    bool front;      // the front face was hit
    vec3s albedo;    // base colour, 0…1
    float metallic, roughness;
    vec3s emission; // towards the ray origin, cd/m²
};

// The nearest hit, front or back face. direction need not be unit. hit may be NULL.
bool trace_closest(const struct trace_scene *scene, vec3s origin, vec3s direction,
                   float max_distance, struct trace_hit *hit);
bool trace_occluded(const struct trace_scene *scene, vec3s origin, vec3s direction,
                    float max_distance);
// Reflectance of the surface that a ray of `direction` hit, for light that bounces, 0…1 per
// channel: surface_reflectance (trace/reflectance.h).
vec3s trace_reflectance(const struct trace_scene *scene, vec3s direction,
                        const struct trace_hit *hit);

// ---- Reference ----------------------------------------------------------------------------------

struct reference_options {
    int bounces;        // of indirect light: 0 direct light alone, 1 one bounce, …; -1: unlimited
    bool direct_only;   // color: direct light alone
    bool indirect_only; // color: indirect light alone
    bool diffuse_only;  // without the specular lobe
    bool guiding;       // learn where light comes from (path guiding)
    bool antialias;     // sample the pixel area; false: its centre, as the frame
    float obscurance_radius_m;   // of the layers obscurance and ambient_occlusion: > 0
    float occlusion_decay_per_m; // of ambient_occlusion over distance (obscurance.c); ≥ 0
    bool obscurance_sphere;      // obscurance of the full sphere, else of the hemisphere
    uint64_t seed;
};
struct reference_options
reference_options_default(void); // bounces -1, guiding, radius 0.5 m, seed 0, all else off

enum reference_layer {
    REFERENCE_COLOR,  // cd/m²: direct + indirect, to the bit
    REFERENCE_DIRECT, // cd/m²: visible emission and sky, and reflected light that arrives directly
                      // from lights, emitters and the sky
    REFERENCE_INDIRECT,                // cd/m²: the rest
    REFERENCE_INDIRECT_EMITTERS_SKY,   // cd/m²: indirect light plus reflected direct light of
                                       // emitters and the sky: the light that techniques add to the
                                       // frame's direct light. The latter part alone with
                                       // direct_only, the former with indirect_only
    REFERENCE_IRRADIANCE,              // lux: of the indirect light; 0 with direct_only
    REFERENCE_IRRADIANCE_EMITTERS_SKY, // lux: of the same light, as a technique's irradiance
    REFERENCE_ALBEDO,                  // at the pixel centre, as all below except error and samples
    REFERENCE_NORMAL,     // shading normal, world space; 0 without a surface, as the next two
    REFERENCE_DEPTH,      // m along the view axis; 1 channel
    REFERENCE_POSITION,   // m
    REFERENCE_ERROR,      // standard error of color, per channel, cd/m²; infinite below 2 samples
    REFERENCE_SAMPLES,    // number of samples; 1 channel
    REFERENCE_OBSCURANCE, // empty share of the volume of a (hemi)sphere (obscurance.c); 1 channel
    REFERENCE_AMBIENT_OCCLUSION, // cosine-weighted visibility up to that radius, with decay;
                                 // 1 channel. Both are 1 without a surface and use one ray per
                                 // sample
    REFERENCE_LAYER_COUNT
};
const char *reference_layer_name(int layer); // "color", …; NULL out of range

struct reference;

// Progressive, starting with 0 samples. width, height: 1…IMAGE_MAX_SIZE. NULL on failure.
struct reference *reference_create(struct host *host, const struct scene_pose *pose,
                                   const struct world_camera *camera, int width, int height,
                                   const struct reference_options *options);
void reference_destroy(struct reference *reference); // accepts NULL

// Adds `samples` to every pixel, on all cores. The result depends neither on the number of cores
// nor on how samples are split over calls. progress (may be NULL) is called on this thread with the
// done share, 0…1; when it returns false, rendering stops with FAIL_CANCELLED and keeps its
// samples. Some pixels then have more samples than others; the next call completes the others
// first.
bool reference_render(struct reference *reference, int samples,
                      bool (*progress)(void *user, double done), void *user);

struct reference_info {
    int samples;   // minimum over the pixels
    uint64_t rays; // traced so far
    double mean;   // mean luminance of color, cd/m²
    double error;  // root mean square over the pixels of the luminance's standard error, cd/m²
};
struct reference_info reference_info(const struct reference *reference);

// Records all rays from now on (trace/embree.h); NULL: stop.
struct ray_log;
void reference_log_rays(struct reference *reference, struct ray_log *log);

// Creates an image of 3 channels (1 where noted above); the caller calls image_finish.
bool reference_read(struct reference *reference, enum reference_layer layer, struct image *out);

// Hash of scene, lights, camera, size and options. References with equal keys take the same
// samples.
uint64_t reference_key(const struct reference *reference);
// The layers to save for resuming later.
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
// Resumes from the saved layers of a run with the same key. Layers have 32-bit floats, sums 64: the
// result equals the uninterrupted one except for rounding.
bool reference_restore(struct reference *reference,
                       const struct image layers[REFERENCE_KEPT_COUNT]);

// ---- strips: 16 adjacent pixels of an image row, as a task of a bake traces them on any machine

enum {
    REFERENCE_STRIP = 16,                              // pixels
    REFERENCE_STRIP_VALUES = REFERENCE_STRIP * 18 + 1, // sums of each pixel, and the rays
};
size_t reference_strip_count(const struct reference *reference);
// Learns where light comes from, on all cores, once; reference_render does it by itself.
bool reference_train(struct reference *reference);
// Adds the samples from…to − 1 of a strip's pixels to its values, which begin as zeros. Requires
// reference_train. Any thread.
void reference_trace_strip(const struct reference *reference, size_t strip, int from, int to,
                           double *values);
// Replaces all samples by those of all strips, [reference_strip_count][REFERENCE_STRIP_VALUES],
// each with the samples 0…samples − 1: to the bit those of reference_render. FAIL_FORMAT where they
// are not finite.
bool reference_set_strips(struct reference *reference, int samples, const double *values);
