// Sample sets in the unit disk, for lines through the unit sphere, and in the unit ball, for points
// (Loos 2015, sec. 6.3.5). tools/samples generates the tables.
//
// Every set of two and more samples is symmetric about the center, which is the first sample if the
// count is odd. Opposite samples are adjacent.
#pragma once

#include <stddef.h>

struct sample {
    float x, y;
    // In the disk: half the length of the sphere's chord at x, y, √(1 − x² − y²).
    float z;
    float weight; // the sphere's volume over (disk) or in (ball) the Voronoi region; the sum is 1
    float share;  // of the disk's area or the ball's volume in that region; the sum is 1
};

struct sample_set {
    int count;
    const struct sample *samples;
    // Visibility beside walls and ramps, estimated with all rotations of the set
    // (tools/samples/noise.c):
    float noise; // root mean square of the standard deviation over rotations
    float bias;  // root mean square of the mean over rotations minus the exact value
};

enum sample_shape { SAMPLE_DISK, SAMPLE_BALL };

// Sample counts of the sets, the same for both shapes.
#define SAMPLE_SET_CHOICES "1|5|6|7|9|12|13|16|33"
#define SAMPLE_SET_COUNT   9
#define SAMPLE_SET_MOST    33 // samples

// index: 0 to SAMPLE_SET_COUNT − 1, in the order of the choices.
const struct sample_set *sample_set_at(enum sample_shape shape, int index);
