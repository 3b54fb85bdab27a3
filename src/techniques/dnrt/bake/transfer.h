// Radiance transfer of an object to a point beside it (Giuffrida 2016, equations 8 and 13), by
// rays.
//
// With c_j the coefficients of the irradiance (lux) at the object, over normals, the object changes
// the irradiance of a receiver by π Σ c_j (t_j − k_j): t_j is light that it reflects, k_j light
// behind it that it hides.
//
//     t_j = 1/π² ∫ ρ Y_j(n) g(ω) dω      k_j = 1/π² ∫ Y_j(ω) g(ω) dω
//
// over the directions ω in which rays from the receiver meet the object, at a point of normal n and
// reflectance ρ. One 1/π is the object's BRDF, or turns irradiance into the mean radiance from
// behind; the other the receiver's. Without a unit. g is the receiver's cosine, of one or several
// normals:
//
//     1   (ω·n_o)₊, n_o towards the object's centre, as in the paper
//     3   ω·x, ω·y, ω·z: the vector irradiance, whose product with a normal is the irradiance of a
//         receiver that has the object above its horizon
//     6   (ω·x)₊, (−ω·x)₊, (ω·y)₊ …: preselected normals (section 9.3)
#pragma once

#include "trace/trace_scene.h"

#include "core/sh.h"

enum { DNRT_MAX_COEFFICIENTS = SH_COUNT(3), DNRT_MAX_NORMALS = 6 };

struct dnrt_vectors {
    vec3s reflected[DNRT_MAX_COEFFICIENTS]; // t, by colour
    float hidden[DNRT_MAX_COEFFICIENTS];    // k
};

struct dnrt_transfer {
    struct dnrt_vectors of[DNRT_MAX_NORMALS];
    int backs; // rays that meet the back of a single-sided surface
};

struct dnrt_sampling {
    const struct trace_scene *trace;
    vec3s centre; // of the bounding sphere
    float radius;
    int bands;
    int rays;
    int normals; // 1, 3 or 6
    // Y_j(n) is replaced by the object's own shadowing and interreflection at the point (appendix
    // B.3).
    bool self;
};

// point: other than the centre. The result depends on the arguments alone.
void dnrt_transfer_at(const struct dnrt_sampling *how, vec3s point, uint32_t seed,
                      struct dnrt_transfer *out);
