// Radiance transfer of an object to a point beside it (Giuffrida 2016, equations 8 and 13), by
// rays.
//
// The receiver faces the object: its normal n_o points to the centre. With c_j the coefficients of
// the irradiance (lux) at the object, over normals, the object changes the receiver's irradiance by
// π Σ c_j (t_j − k_j): t_j is light that it reflects, k_j light behind it that it hides.
//
//     t_j = 1/π² ∫ ρ Y_j(n) (ω·n_o)₊ dω      k_j = 1/π² ∫ Y_j(ω) (ω·n_o)₊ dω
//
// over the directions ω in which rays meet the object, at a point of normal n and reflectance ρ.
// One 1/π is the object's BRDF, or turns irradiance into the mean radiance from behind; the other
// the receiver's. Without a unit.
#pragma once

#include "trace/trace_scene.h"

#include "core/sh.h"

enum { DNRT_MAX_COEFFICIENTS = SH_COUNT(3) };

struct dnrt_transfer {
    vec3s reflected[DNRT_MAX_COEFFICIENTS]; // t, by colour
    float hidden[DNRT_MAX_COEFFICIENTS];    // k
    float inside; // share of the rays that meet the back of a single-sided surface
};

struct dnrt_sampling {
    const struct trace_scene *trace;
    vec3s centre; // of the bounding sphere
    float radius;
    int bands;
    int rays;
};

// point: other than the centre. The result depends on the arguments alone.
struct dnrt_transfer dnrt_transfer_at(const struct dnrt_sampling *how, vec3s point, uint32_t seed);
