// Sets of samples by repulsion (Loos 2015, sec. 6.3.5).
#pragma once

#include "voronoi.h"

#include "core/rng.h"

// How a start is arranged before the samples repel each other; the forces keep it.
enum start { START_FREE, START_SYMMETRIC, START_KINDS };

// A random start without near neighbours. START_SYMMETRIC: with every sample its reflection in the
// centre, and the centre itself where the count is odd.
struct points optimise_start(bool ball, int count, enum start start, struct rng *rng);
// Moves the samples until no move makes the regions more equal. Returns voronoi_error on that grid.
double optimise(struct points *set, const struct grid *grid);
