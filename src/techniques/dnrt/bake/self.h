// Light that an object reflects at a point of its surface.
#pragma once

#include "core/rng.h"
#include "core/sh.h"
#include "trace/surface.h"

// ρ T_j by colour: the reflectance times the irradiance at the point, of irradiance Y_j(n) over
// normals n in space. Without `self` T_j = Y_j of the normal. With it, light that the object
// occludes at the point is replaced by light that it reflects there (Sloan 2002, diffuse
// self-transfer): one path, whose mean is exact but for its end after 16 bounces.
void dnrt_reflected(const struct trace_scene *trace, int bands, bool self,
                    const struct surface *surface, struct rng *rng, vec3s *out);

// A cosine-distributed direction around the surface's normal.
vec3s dnrt_cosine_direction(const struct surface *surface, vec2s u);
// Coefficients of the irradiance whose radiance is a cosine-distributed sample of `direction`: 1
// over the density cosθ/π, over the bands' factors π, 2π/3 and π/4.
void dnrt_occluded(int bands, vec3s direction, float *out);
