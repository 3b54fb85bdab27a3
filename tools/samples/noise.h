// How much the estimate of a set depends on how the set is turned: what a picture shows as noise,
// since every pixel turns it another way.
#pragma once

#include "voronoi.h"

struct noise {
    double turns; // root mean square over surfaces of the standard deviation over turns
    double bias;  // root mean square over surfaces of the mean over turns, less the exact value
};
// Visibility of the hemisphere above a floor that faces the eye, beside walls and ramps: see
// noise.c.
struct noise noise_of(const struct points *set, const struct voronoi *voronoi);
