// Sets of samples by repulsion (Loos 2015, sec. 6.3.5).
#pragma once

#include "voronoi.h"

#include "core/rng.h"

// Symmetry of a random start; the forces preserve it.
enum start { START_FREE, START_SYMMETRIC, START_KINDS };

// A random start with a minimum distance. START_SYMMETRIC: point-symmetric about the centre, with a
// sample at the centre where the count is odd.
struct points optimise_start(bool ball, int count, enum start start, struct rng *rng);
// Minimizes voronoi_error on the grid, and returns it.
double optimise(struct points *set, const struct grid *grid);
