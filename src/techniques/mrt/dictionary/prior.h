// Light prior (Loos 2015, sections 3.3 and 4.1.1): the direct light of sphere lights inside a
// shape, beyond each opening, and diagonally beyond two openings that share an edge.
#pragma once

#include "techniques/mrt/dictionary/shape.h"

// Sphere lights of 1 cd, on a lattice at (i + 1)/7 of the edge in the shape and its neighbours.
// Their radius is half the lattice spacing.
struct mrt_prior_light {
    vec3s centre;
    bool inside;
};

enum {
    PRIOR_LATTICE = 6, // lights along an edge
    PRIOR_BEYOND = 3,  // layers of the lattice beyond an opening
};

int mrt_prior_light_count(const struct mrt_shape *shape);
// Shadow rays of all lights, for estimates.
double mrt_prior_rays(const struct mrt_shape *shape);
void mrt_prior_lights(const struct mrt_shape *shape, struct mrt_prior_light *lights);

// Irradiance (lux, for an edge of 1 m) at each texel: column[texel * stride].
void mrt_prior_column(const struct mrt_shape *shape, struct mrt_prior_light light, float *column,
                      size_t stride);

// Irradiance of an unoccluded point light of 1 cd, which is that of a sphere light above the
// horizon.
float mrt_point_light(struct mrt_point at, vec3s light);
