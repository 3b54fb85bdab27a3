// Sets of cones over a hemisphere. Pure CPU.
#pragma once

#include "core/vec.h"

enum { VCT_CONES_1, VCT_CONES_5, VCT_CONES_6, VCT_CONES_9, VCT_CONES_16, VCT_CONES_25 };

struct vct_cone {
    vec3s direction; // unit, about +z
    float weight;    // ∫ cos dω over its part of the hemisphere, sr
};

// How many cones a choice has.
int vct_cone_count(int choice);
// The hemisphere in parts of equal solid angle 2π/count: a cap and rings, whose parts are equal.
// Weights sum to π.
void vct_cone_set(int choice, struct vct_cone *out);
// Width over distance of a cone of solid angle 2π/count: 2 tan of its half-angle.
float vct_cone_width(int choice);
// As many lines through the sphere's centre, spread evenly: unit vectors of which it does not
// matter to which side they point. On every hemisphere they are a set of cones of nearly equal
// solid angles, whatever its normal.
void vct_cone_axes(int choice, vec3s *out);
// Turns them all by the same rotation, number 0 by none; many numbers turn a line to everywhere
// evenly.
void vct_rotate_cone_axes(uint32_t number, int count, vec3s *lines);
