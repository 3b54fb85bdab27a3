// Rays around a probe, in equal squares of the octahedral map (frame/octahedral.h): its place
// outside geometry, and its depths.
#pragma once

#include "techniques/common/probes/depth_map.h"

#include <stdint.h>

struct probe_ray {
    vec3s from, direction;
    float solid_angle; // of its part of the sphere; 0: its distance alone is needed
};

// Returns the distance of the first hit, INFINITY: none. *inside: it is the back of a single-sided
// surface.
struct probe_tracer {
    float (*trace)(void *user, const struct probe_ray *ray, bool *inside);
    void *user;
};

// The middle of a cell, or where that is inside geometry, the nearest place outside, in front of a
// surface, within the cell. False: there is none.
bool probe_find_place(const struct probe_tracer *tracer, vec3s center, float spacing_m,
                      vec3s *position);

// A grid of about `rays` directions.
struct probe_sphere {
    int side;    // rays along an edge of the map
    float scale; // solid angles of the rays sum to 4π with it
};
struct probe_sphere probe_sphere_of(int rays);

// Solid angle of the square around a direction, sr.
float probe_solid_angle(const struct probe_sphere *sphere, vec3s direction);

// The depths of a probe: common/probes/lookup.glsl. Halves.
void probe_trace_depths(const struct probe_sphere *sphere, const struct probe_tracer *tracer,
                        vec3s from, float spacing_m, uint16_t depth[PROBE_DEPTHS][2]);
