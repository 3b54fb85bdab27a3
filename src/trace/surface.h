// Surface attributes at a ray hit: interpolated vertex attributes, maps, normals.
#pragma once

#include "trace/bsdf.h"
#include "trace/trace_scene.h"

// Ray differentials of a camera ray, whose direction has the length 1 along the view axis.
struct pixel_footprint {
    vec3s direction, dx, dy;
    vec3s origin;
};

struct surface {
    vec3s position;
    vec3s geometric; // unit, facing the ray origin
    vec3s normal;    // shading normal, unit, same side
    float reach;     // offset of rays that leave the surface, m
    bool front;
    struct bsdf_material material;
    bool unlit;     // shown by its base colour at the primary hit, black for all other light
    vec3s emission; // cd/m², towards the ray origin
    uint32_t mesh, triangle;
};

// footprint NULL: samples maps at level 0.
void surface_at(const struct trace_scene *scene, const struct ray *ray, const struct ray_hit *hit,
                const struct pixel_footprint *footprint, struct surface *out);
// Prefetches the memory that surface_at reads, in three steps: each needs the data of the one
// before.
void surface_prefetch(const struct trace_scene *scene, const struct ray_hit *hit);
void surface_prefetch_corners(const struct trace_scene *scene, const struct ray_hit *hit);
void surface_prefetch_texels(const struct trace_scene *scene, const struct ray_hit *hit);
// The origin of a ray that leaves the surface along `direction`.
static inline vec3s surface_leave(const struct surface *s, vec3s direction)
{
    float side = glms_vec3_dot(s->geometric, direction) < 0.0f ? -s->reach : s->reach;
    return glms_vec3_muladds(s->geometric, side, s->position);
}
// Black where unlit.
static inline const struct bsdf_material *surface_bsdf_material(const struct surface *s)
{
    static const struct bsdf_material black = { .roughness = 1.0f };
    return s->unlit ? &black : &s->material;
}
static inline struct bsdf surface_bsdf(const struct surface *s, vec3s to_viewer, bool diffuse_only)
{
    return bsdf_of(s->normal, to_viewer, surface_bsdf_material(s), diffuse_only);
}
// Emission at a point of a triangle from level 0, cd/m², regardless of side.
vec3s surface_emission(const struct trace_mesh *mesh, uint32_t triangle, float u, float v);
// embree_solid of alpha-masked geometry; view: a pixel_footprint or NULL.
bool surface_is_solid(const void *mesh, uint32_t triangle, float u, float v, const void *view);
