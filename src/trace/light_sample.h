// Light that comes straight from lights, emitters and the sky: what there is, and samplers.
#pragma once

#include "scene/pose.h"

struct trace_scene;

#define NO_EMITTER UINT32_MAX

// A triangle that glows, with what a sample of it asks for.
struct emitter {
    uint32_t mesh, triangle;
    vec3s corner, edges[2]; // a point is corner + b1 · edges[0] + b2 · edges[1]
    vec3s normal;           // unit, of the front
    vec3s radiance;         // cd/m²; of mapped ones the factor
    float reach;            // as a facet's, m
    bool mapped, double_sided;
    float density; // of light_sample_emitter, per m²; 0: never chosen
    // Alias table (Walker 1977; Vose 1991): with the chance `stay` this one, else `alias`.
    float stay;
    uint32_t alias;
};

struct light_table {
    struct world_light *punctual;
    int punctual_count;
    struct emitter *emitters; // all triangles of emissive instances, mesh after mesh
    uint32_t emitter_count;
    vec3s sky;
    bool has_sky, has_emitters; // of some light
};

// Fills scene->lights and the meshes' emitter_first. light_table_finish accepts a half-made table.
bool light_table_init(struct trace_scene *scene, const struct scene_pose *pose);
void light_table_finish(struct trace_scene *scene);

// From a point towards a punctual light: the unit direction to it, its distance (infinite for suns)
// and the illuminance of a surface there that faces it, lux (light.glsl).
struct punctual_light {
    vec3s to_light;
    float distance_m;
    vec3s illuminance;
};
struct punctual_light light_punctual(const struct world_light *light, vec3s position);

// A point on an emitter, chosen by power.
struct emitter_sample {
    vec3s position; // on the side that glows towards the receiver
    vec3s to_light; // unit
    vec3s radiance; // cd/m²; 0 where it does not glow that way
    float pdf;      // of the direction, 1/sr
};
struct emitter_sample light_sample_emitter(const struct trace_scene *scene, vec3s from,
                                           float choice, vec2s u);
// The density, 1/sr, with which light_sample_emitter would have given this point.
float light_emitter_pdf(const struct trace_scene *scene, uint32_t mesh, uint32_t triangle,
                        float distance_m, float cosine);
