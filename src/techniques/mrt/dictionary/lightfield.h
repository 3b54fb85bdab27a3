// Lightfield of an interface (Loos 2015, sections 3.4.1 and 4.2): radiosity (π · radiance, lm/m²)
// that passes a unit square or the disk at the end of a tube, at a grid of positions and of
// directions.
//
// The frame of the interface has its origin at the centre of the square; z is the direction of
// travel, y is v and x is u of the face (cube.h). Directions are a square grid on the concentric
// map of the hemisphere z > 0, projected on the disk: every sample stands for the same flux, and
// the Euclidean norm of a lightfield does not change as it propagates.
#pragma once

#include "core/vec.h"

#include <stddef.h>

struct mrt_lightfield {
    int positions, directions; // along an edge of each square
    int supersampling;         // directions per sample, along an edge
    bool round;                // positions fill the disk of a tube, by the concentric map
};

enum { LIGHTFIELD_LOOKUP = 16 };

// Samples are ordered by direction within position: ((j · positions + i) · directions + b) ·
// directions + a for position (i, j) and direction (a, b).
static inline size_t mrt_lightfield_samples(struct mrt_lightfield l)
{
    size_t positions = (size_t)l.positions, directions = (size_t)l.directions;
    return positions * positions * directions * directions;
}

static inline int mrt_lightfield_subsamples(struct mrt_lightfield l)
{
    return l.supersampling * l.supersampling;
}

// Centre of the position of a sample, z = 0.
vec3s mrt_lightfield_position(struct mrt_lightfield l, size_t sample);
// Direction `sub` of the supersampled directions of a sample, a unit vector with z > 0.
vec3s mrt_lightfield_direction(struct mrt_lightfield l, size_t sample, int sub);
// Quadrilinear lookup at (x, y, 0) in direction `direction`, clamped at all edges. Weights sum to
// 1.
struct mrt_lightfield_lookup {
    size_t sample[LIGHTFIELD_LOOKUP];
    float weight[LIGHTFIELD_LOOKUP];
};
void mrt_lightfield_look_up(struct mrt_lightfield l, float x, float y, vec3s direction,
                            struct mrt_lightfield_lookup *out);
