// Whether a point is inside geometry: most of its rays first meet the back of a surface. Backs are
// those of single-sided surfaces, but for mrt and drt: there objects with closed surfaces of a
// double-sided material have an inside, too.
#pragma once

#include "trace/embree.h"

struct trace_scene;

static inline bool is_inside(int backs, int rays)
{
    return 2 * backs > rays;
}

// 1: the back of a single-sided surface, −1: its front, 0: a double-sided one.
int inside_side_of(const struct trace_scene *scene, const struct ray *ray,
                   const struct ray_hit *hit);

enum { INSIDE_RAYS = 16 };
// Ray k of INSIDE_RAYS, cosine-distributed above a surface.
struct ray inside_ray(vec3s from, vec3s normal, uint32_t k);
// How many of the rays first…end − 1 meet the back of a single-sided surface.
int inside_backs(const struct trace_scene *scene, vec3s from, vec3s normal, uint32_t first,
                 uint32_t end);

enum { INSIDE_CROSSINGS = 6 }; // rays that count all surfaces
// Backs less fronts that those rays meet up to infinity.
int inside_crossings(const struct trace_scene *scene, vec3s from, vec3s normal);
// Whether most rays first meet a back, or leave a solid.
bool inside_solid(const struct trace_scene *scene, vec3s from, vec3s normal);
