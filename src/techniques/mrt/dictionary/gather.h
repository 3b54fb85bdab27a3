// Gather operators of a shape: rows that turn radiosity at its texels into light at a point
// (equation 3.1). F, the one-bounce operator, has one row of MRT_IRRADIANCE per texel: with
// reflectance in the radiosity, indirect irradiance = F · radiosity. In a closed shape rows of F
// sum to 1.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/dictionary/shape.h"

// Adds to rows[q * stride + texel] for the quantities q of `rays`.
void mrt_gather(const struct mrt_shape *shape, struct mrt_point point, const struct mrt_rays *rays,
                float *rows, size_t stride);

// Adds to row[m] `weight` times the radiosity at a hit of mode m: radiosity is texels × modes.
void mrt_add_radiosity(const struct mrt_hit *hit, float weight, const struct matrix_f32 *radiosity,
                       float *row);
