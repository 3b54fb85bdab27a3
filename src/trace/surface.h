// What a ray meets: interpolated attributes, maps, normals.
#pragma once

#include "trace/bsdf.h"
#include "trace/trace_scene.h"

// How a ray of the camera changes from one pixel to the next; the ray's direction is 1 along the
// view axis.
struct pixel_footprint {
    vec3s direction, dx, dy;
    vec3s origin;
};

struct surface {
    vec3s position;
    vec3s geometric; // unit, on the side that the ray comes from
    vec3s normal;    // shading normal on that side, unit
    float reach;     // how far to leave the surface, m
    bool front;
    vec3s albedo;
    float metallic, roughness;
    vec3s emission; // cd/m², towards where the ray comes from
    uint32_t mesh, triangle;
};

// footprint NULL: maps at their full resolution.
void surface_at(const struct trace_scene *scene, const struct ray *ray, const struct ray_hit *hit,
                const struct pixel_footprint *footprint, struct surface *out);
// What surface_at will read of a hit is asked for from memory, each of three steps after the one
// before has had its time.
void surface_expect(const struct trace_scene *scene, const struct ray_hit *hit);
void surface_expect_corners(const struct trace_scene *scene, const struct ray_hit *hit);
void surface_expect_texels(const struct trace_scene *scene, const struct ray_hit *hit);
// A point beside the surface, on the side of `direction`.
static inline vec3s surface_leave(const struct surface *s, vec3s direction)
{
    float side = glms_vec3_dot(s->geometric, direction) < 0.0f ? -s->reach : s->reach;
    return glms_vec3_muladds(s->geometric, side, s->position);
}
// Emission of a triangle's point at full resolution, cd/m², whatever the side.
vec3s surface_emission(const struct trace_mesh *mesh, uint32_t triangle, float u, float v);
// embree_solid of masked geometries; view: a pixel_footprint or NULL.
bool surface_is_solid(const void *mesh, uint32_t triangle, float u, float v, const void *view);
