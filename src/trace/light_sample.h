// Punctual lights, emitters and the sky of a scene, and how to sample them.
#pragma once

#include "scene/pose.h"
#include "trace/environment_sample.h"

struct trace_scene;

#define NO_EMITTER UINT32_MAX

// An emissive triangle, with the data of its samples.
struct emitter {
    uint32_t mesh, triangle;
    vec3s corner, edges[2]; // a point is corner + b1 · edges[0] + b2 · edges[1]
    vec3s normal;           // unit, of the front
    vec3s radiance;         // cd/m²; with an emissive map the factor
    float reach;            // trace_facet.reach, m
    bool textured, double_sided;
    float density; // of light_sample_emitter, per m²; 0: never sampled
    // Alias table (Walker 1977; Vose 1991): this triangle with probability `stay`, else `alias`.
    float stay;
    uint32_t alias;
};

struct light_table {
    struct world_light *punctual;
    int punctual_count;
    struct emitter *emitters; // all triangles of emissive instances, mesh after mesh
    uint32_t emitter_count;
    struct environment environment; // with a reference to its map
    struct environment_table environment_table;
    bool has_sky, has_emitters; // has_emitters: of power above 0
    float flux;                 // of all emitters, lumen
    float unlit_white;          // scene/unlit.h, cd/m²
};

// Fills scene->lights and the meshes' emitter_first. light_table_finish accepts a half-built table.
bool light_table_init(struct trace_scene *scene, const struct scene_pose *pose);
void light_table_finish(struct trace_scene *scene);
// The alias table of Vose 1991: `stay` and `alias` of emitters. scaled: their weights divided by
// the mean, overwritten. work: [count].
void light_table_build_alias(struct emitter *emitters, uint32_t count, double *scaled,
                             uint32_t *work);

// A punctual light as seen from a point: unit direction, distance (infinite for directional lights)
// and illuminance at normal incidence, lux (light.glsl).
struct punctual_light {
    vec3s to_light;
    float distance_m;
    vec3s illuminance;
};
struct punctual_light light_punctual(const struct world_light *light, vec3s position);

// A point on an emitter, chosen by power.
struct emitter_sample {
    vec3s position; // offset to the emissive side facing the receiver
    vec3s to_light; // unit
    vec3s radiance; // cd/m²; 0 towards a back face
    float pdf;      // of the direction, 1/sr
    uint32_t mesh;  // of the emitter, in trace_scene.meshes
};
struct emitter_sample light_sample_emitter(const struct trace_scene *scene, vec3s from,
                                           float choice, vec2s u);
// The pdf, 1/sr, of light_sample_emitter for this point.
float light_emitter_pdf(const struct trace_scene *scene, uint32_t mesh, uint32_t triangle,
                        float distance_m, float cosine);
