// Samples of emissive surfaces at a receiver by the balance heuristic (Veach & Guibas 1995): rays,
// good for emitters that fill much of its view, and the frame's virtual point lights with shadow
// rays, good for small ones.
//
// Densities are samples per square metre of emitter: a point has the mean one of its instance, a
// ray N p cosθ' / d² at distance d, p its density per steradian.
#pragma once

#include "frame/emitters.h"
#include "trace/trace.h"

struct mrt_emitter_samples {
    struct host *host;
    const struct trace_scene *scene;
    const struct emitters *emitters;
    float *points_per_m2; // [instances], of all points
    int rays;             // of a receiver
};

bool mrt_emitter_samples_init(struct mrt_emitter_samples *out, struct host *host,
                              const struct trace_scene *scene, const struct emitters *emitters,
                              int instances);
void mrt_emitter_samples_finish(struct mrt_emitter_samples *samples); // accepts zero

// A surface, whose rays are cosine-distributed, or a point with uniform rays: normal 0.
struct mrt_receiver {
    vec3s position, normal;
};

// The points that receiver i takes: every step-th, so that errors do not line up.
struct mrt_point_subset {
    int first, step;
    float share; // of all points over those taken
};
struct mrt_point_subset mrt_points_of(const struct mrt_emitter_samples *samples, size_t i);

// Lux of point i on a surface that faces it; `direction` to the point is unit.
vec3s mrt_light_of_point(const struct mrt_emitter_samples *samples,
                         const struct mrt_receiver *receiver, int i,
                         const struct mrt_point_subset *subset, vec3s *direction);
// π times the radiance of a ray's hit, weighed against points.
vec3s mrt_light_of_hit(const struct mrt_emitter_samples *samples,
                       const struct mrt_receiver *receiver, vec3s direction,
                       const struct trace_hit *hit);
