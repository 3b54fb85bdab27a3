// Cone sets over a hemisphere. Pure CPU.
#pragma once

#include "core/vec.h"

enum { VCT_CONES_1, VCT_CONES_5, VCT_CONES_6, VCT_CONES_9, VCT_CONES_16, VCT_CONES_25 };

struct vct_cone {
    vec3s direction; // unit, about +z
    float weight;    // ∫ cos θ dω over its part of the hemisphere, sr
};

// Number of cones of a choice.
int vct_cone_count(int choice);
// Stratifies the hemisphere into a cap and rings of cones with equal solid angle 2π/count.
// Weights sum to π.
void vct_cone_set(int choice, struct vct_cone *out);
// Width over distance of a cone of solid angle 2π/count: twice the tangent of the half-angle.
float vct_cone_width(int choice);
// `count` evenly spread lines through the centre of the sphere, as unit vectors of either sign. For
// any normal, one end of each line lies in the hemisphere: a cone set of nearly equal solid angles.
void vct_cone_axes(int choice, vec3s *out);
// Rotates all lines by rotation `number` of a low-discrepancy sequence; 0 is the identity.
void vct_rotate_cone_axes(uint32_t number, int count, vec3s *lines);
// Axes of a hemisphere of strata for rays, in rotation `number`.
void vct_stratum_axes(uint32_t number, vec3s out[3]);
