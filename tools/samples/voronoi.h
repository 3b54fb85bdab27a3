// Discrete Voronoi diagrams of a few samples in the unit disk or the unit ball.
//
// A cell of the disk's grid has the weight of the unit sphere's extent above it, 2 √(1 − r²) dA,
// one of the ball's its volume dV; both over the sphere's volume 4π/3, so that all weights add up
// to 1 (Loos 2015, sec. 6.3.5, footnote 6).
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { MAX_SAMPLES = 64 };

struct point {
    double x, y, z; // z is 0 in the disk
};

struct points {
    bool ball; // else a disk
    int count;
    struct point at[MAX_SAMPLES];
};

struct cell {
    struct point at;
    double weight;
};

struct grid {
    struct cell *cells;
    size_t count;
};

// side: cells across. false: no memory.
bool grid_init(struct grid *grid, bool ball, int side);
void grid_finish(struct grid *grid);

struct voronoi {
    double weight[MAX_SAMPLES]; // of each sample's region; they add up to 1
    double share[MAX_SAMPLES];  // of the disk's area, or the ball's volume; they add up to 1
    struct point centroid[MAX_SAMPLES]; // weighted
};
struct voronoi voronoi_of(const struct points *set, const struct grid *grid);
// How far regions are from equal weights, and samples from their region's centroid: the root mean
// square of N W − 1, plus that of the distances.
double voronoi_error(const struct points *set, const struct voronoi *voronoi);
