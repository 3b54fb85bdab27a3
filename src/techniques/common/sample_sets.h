// Samples in the unit disk, for lines through the unit sphere, and in the unit ball, for points in
// it (Loos 2015, sec. 6.3.5). tools/samples makes the tables.
//
// Every set of two and more is symmetric about the centre, which is its first sample where the
// count is odd; opposite samples follow each other.
#pragma once

#include <stddef.h>

struct sample {
    float x, y;
    float z; // in the disk half the length of the line through the sphere there, √(1 − x² − y²)
    float weight; // the sphere's volume over (disk) or in (ball) the sample's Voronoi region; all
                  // add up to 1
    float share;  // of the disk's area, or the ball's volume, in that region; all add up to 1
};

struct sample_set {
    int count;
    const struct sample *samples;
    // Of the visibility beside walls and ramps, estimated with the set turned every way
    // (tools/samples/noise.c):
    float noise; // root mean square of the standard deviation over turns
    float bias;  // root mean square of the mean over turns, less the exact value
};

enum sample_shape { SAMPLE_DISK, SAMPLE_BALL };

// How many samples the sets have, in ascending order, the same for both shapes.
#define SAMPLE_SET_CHOICES "1|5|6|7|9|12|13|16|33"
#define SAMPLE_SET_COUNT   9
#define SAMPLE_SET_MOST    33 // samples

// index: 0 … SAMPLE_SET_COUNT − 1, in the order of the choices.
const struct sample_set *sample_set_at(enum sample_shape shape, int index);
