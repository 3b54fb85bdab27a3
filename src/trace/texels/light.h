// Light of emissive surfaces and the sky at a point, by rays and by samples of emitters. Both are
// weighted by the balance heuristic (Veach 1997, section 9.2): rays alone find small emitters by
// chance.
#pragma once

#include "scene/emission_basis.h"
#include "trace/trace_scene.h"

// Further rays of a surface in cells of its hemisphere: side × side squares of the unit square that
// sample_hemisphere_cosine takes, of equal irradiance in uniform light.
struct texel_cells {
    uint32_t side;          // side² divides the number of rays; 0: no cells
    const uint8_t *further; // [side²], rays of a cell beside its part of all: a power of two, or 0
};

// The cell of a point of the unit square.
static inline uint32_t texel_cell_at(uint32_t side, vec2s at)
{
    const uint32_t x = (uint32_t)(at.x * (float)side), y = (uint32_t)(at.y * (float)side);
    return (y < side ? y : side - 1) * side + (x < side ? x : side - 1);
}

// A surface, whose rays are cosine-distributed, or a point with uniform rays: normal 0.
struct texel_receiver {
    vec3s position, normal; // position: offset against self-intersection
    const vec3s *places;    // of samples in turn, in place of `position`; place_count 0: none
    uint32_t place_count;
    int rays, light_samples;
    uint32_t first; // of the rays' points in the Sobol sequence
    uint32_t seed;
    struct texel_cells cells;
    const struct emission_basis *emission; // of the trace scene's materials; NULL: no columns
};

enum { RAYS_PER_LIGHT_SAMPLE = 4 };

// Emitter samples of a texel with `rays` rays; 0 without emissive surfaces.
static inline int texel_light_samples(const struct trace_scene *scene, int rays)
{
    return scene->lights.has_emitters ? rays / RAYS_PER_LIGHT_SAMPLE : 0;
}

// The first hit of a ray.
struct texel_hit {
    bool back, inside; // inside: the back of a single-sided surface
    uint32_t mesh;     // in trace_scene.meshes
    vec3s emission;    // cd/m²; 0: none
    float pdf;         // of light_sample_emitter, sr⁻¹
    float share;       // of the surface's irradiance in uniform light that the ray stands for
};
// Without its share.
struct texel_hit texel_hit_at(const struct trace_scene *scene, const struct ray *ray,
                              const struct ray_hit *hit);

// Samples of a direction per steradian, of both kinds; pdf_light: of light_sample_emitter.
float texel_sample_density(const struct texel_receiver *receiver, vec3s direction, float pdf_light);

// Sample k of `count` on emissive surfaces. False: its light does not arrive; with a normal, at
// that side of a surface.
bool texel_sample_emitter(const struct trace_scene *scene, vec3s position, const vec3s *normal,
                          uint32_t k, uint32_t count, uint32_t seed, struct emitter_sample *out);

// Irradiance on the texel, and the integral of radiance times direction over its hemisphere (the
// vector irradiance), whose component along the normal is that irradiance.
struct texel_light {
    float irradiance, vector[3];
};

struct texel_lights {
    struct texel_light sky;                 // of radiance 1
    float sky_patches[ENVIRONMENT_PATCHES]; // irradiance by patches of radiance 1
    float sky_fluence;                      // ∫ L dω of radiance 1
    struct texel_light emitted[3];          // by colour, lux
    // By columns, for a radiance of 1; with texel_receiver.emission.
    struct texel_light columns[EMISSION_COLUMNS];
    float column_fluence[EMISSION_COLUMNS]; // ∫ L dω likewise
    // The vector irradiance of radiance 1 from everywhere, by the same samples: along the surface
    // it is their error, of which light that is nearly uniform has the same share.
    float uniform_vector[3];
};

// Calls `add` with the columns of emission of a mesh's material, and the radiance of each.
typedef void (*texel_add_column)(void *user, int column, float radiance);
void texel_emission_columns(const struct trace_scene *scene, const struct emission_basis *emission,
                            uint32_t mesh, vec3s radiance, texel_add_column add, void *user);

// Calls `visit`, which may be NULL, for each ray that meets a surface; local: its direction in the
// basis of the normal (basis_of). The receiver is a surface.
typedef void (*texel_visit)(void *user, const struct ray *ray, const struct ray_hit *hit,
                            vec3s local, const struct texel_hit *at_hit);
void texel_gather_light(const struct trace_scene *scene, const struct texel_receiver *receiver,
                        texel_visit visit, void *user, struct texel_lights *out);
// The same, and `miss` for each ray that reaches the sky. Either may be NULL.
struct texel_visitor {
    texel_visit hit;
    void (*miss)(void *user, vec3s direction);
    void *user;
};
void texel_gather(const struct trace_scene *scene, const struct texel_receiver *receiver,
                  const struct texel_visitor *visitor, struct texel_lights *out);

// Shares of the patches in the irradiance of the sky, of 255; all 0 without sky.
void texel_sky_shares(const struct texel_lights *lights, uint8_t out[ENVIRONMENT_PATCHES]);
