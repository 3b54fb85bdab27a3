// Variation of a set's estimates over rotations of the set: noise in the image, since each pixel
// rotates the set differently.
#pragma once

#include "voronoi.h"

struct noise {
    double deviation; // standard deviation over rotations, root mean square over surfaces
    double bias;      // mean over rotations minus the exact value, root mean square over surfaces
};
// For the visibility of the hemisphere above a floor next to walls and ramps; see noise.c.
struct noise noise_of(const struct points *set, const struct voronoi *voronoi);
