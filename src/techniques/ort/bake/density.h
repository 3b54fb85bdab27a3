// A continuous probability density over the plane from unordered data points: piecewise linear on
// their Delaunay triangulation (Sunshine-Hill 2006, appendix A).
#pragma once

#include "core/rng.h"
#include "techniques/ort/bake/delaunay.h"

struct ort_point {
    float x, y, value; // value ≥ 0
};

struct ort_density {
    struct host *host;
    struct ort_point *points; // distinct, by y, then x
    uint32_t point_count;
    struct ort_triangles triangles;
    double *sums;    // of the volumes of tetrahedra 0…i; tetrahedron i is of triangle i / 3
    double integral; // over the hull
};

// The values of points at the same place are averaged. The result does not depend on the order of
// the points. Where all values are 0, so are the density and its integral, and samples are uniform
// over the hull. FAIL_ARGUMENT where a number is not finite or a value is negative, and as
// ort_delaunay. `out` is finished on failure.
bool ort_density_init(struct ort_density *out, struct host *host, const struct ort_point *points,
                      uint32_t count);
void ort_density_finish(struct ort_density *density); // accepts zero

// Not normalised: at a data point its value, 0 outside of the hull. Visits all triangles.
float ort_density_at(const struct ort_density *density, float x, float y);
// A point with the density as its probability, up to the integral: O(log n), eight random words.
void ort_density_sample(const struct ort_density *density, struct rng *rng, float at[2]);
