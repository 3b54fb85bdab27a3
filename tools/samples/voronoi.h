// Discrete Voronoi diagrams of a few samples in the unit disk or the unit ball.
//
// The weight of a cell is the unit sphere's volume above it, 2 √(1 − r²) dA (disk), or its own
// volume dV (ball), relative to the sphere's volume 4π/3. All weights sum to 1 (Loos 2015, sec.
// 6.3.5, footnote 6).
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { MAX_SAMPLES = 64 };

struct point {
    double x, y, z; // z is 0 in the disk
};

struct points {
    bool ball; // false: disk
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

// side: number of cells along an axis. False when out of memory.
bool grid_init(struct grid *grid, bool ball, int side);
void grid_finish(struct grid *grid);

struct voronoi {
    double weight[MAX_SAMPLES];         // of each sample's region; sum 1
    double share[MAX_SAMPLES];          // of the disk's area or the ball's volume; sum 1
    struct point centroid[MAX_SAMPLES]; // weighted
};
struct voronoi voronoi_of(const struct points *set, const struct grid *grid);
// Deviation of the weights W from equality and of the samples from their centroids: the root mean
// square of N W − 1 plus that of the distances.
double voronoi_error(const struct points *set, const struct voronoi *voronoi);
