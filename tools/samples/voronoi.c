// Discrete Voronoi diagrams: each cell of a grid belongs to its nearest sample.
#include "voronoi.h"

#include <math.h>
#include <stdlib.h>

static double squared_distance(struct point a, struct point b)
{
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return x * x + y * y + z * z;
}

static void add_cell(struct grid *grid, bool ball, struct point at)
{
    const double r2 = at.x * at.x + at.y * at.y + at.z * at.z;
    if (r2 >= 1.0) return;
    grid->cells[grid->count++] = (struct cell){ at, ball ? 1.0 : sqrt(1.0 - r2) };
}

// Normalizes the weights to a sum of 1, which replaces the division by 4π/3 and corrects the grid's
// error at the rim.
static void normalize(struct grid *grid)
{
    double sum = 0.0;
    for (size_t i = 0; i < grid->count; i++) sum += grid->cells[i].weight;
    for (size_t i = 0; i < grid->count; i++) grid->cells[i].weight /= sum;
}

bool grid_init(struct grid *grid, bool ball, int side)
{
    const size_t n = (size_t)side;
    *grid = (struct grid){ .cells = malloc((ball ? n * n * n : n * n) * sizeof *grid->cells) };
    if (!grid->cells) return false;
    for (int k = 0; k < (ball ? side : 1); k++)
        for (int j = 0; j < side; j++)
            for (int i = 0; i < side; i++)
                add_cell(grid, ball,
                         (struct point){ (2 * i + 1.0) / side - 1.0, (2 * j + 1.0) / side - 1.0,
                                         ball ? (2 * k + 1.0) / side - 1.0 : 0.0 });
    normalize(grid);
    return true;
}

void grid_finish(struct grid *grid)
{
    free(grid->cells);
    *grid = (struct grid){ 0 };
}

static int nearest(const struct points *set, struct point at)
{
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < set->count; i++) {
        const double d = squared_distance(set->at[i], at);
        if (d >= least) continue;
        least = d;
        best = i;
    }
    return best;
}

struct voronoi voronoi_of(const struct points *set, const struct grid *grid)
{
    struct voronoi v = { 0 };
    for (size_t c = 0; c < grid->count; c++) {
        const struct cell *cell = &grid->cells[c];
        const int i = nearest(set, cell->at);
        v.weight[i] += cell->weight;
        v.share[i] += 1.0 / (double)grid->count;
        v.centroid[i].x += cell->weight * cell->at.x;
        v.centroid[i].y += cell->weight * cell->at.y;
        v.centroid[i].z += cell->weight * cell->at.z;
    }
    for (int i = 0; i < set->count; i++) {
        const double w = v.weight[i] > 0.0 ? 1.0 / v.weight[i] : 0.0;
        v.centroid[i] =
            (struct point){ v.centroid[i].x * w, v.centroid[i].y * w, v.centroid[i].z * w };
    }
    return v;
}

double voronoi_error(const struct points *set, const struct voronoi *v)
{
    double unequal = 0.0, off = 0.0;
    for (int i = 0; i < set->count; i++) {
        const double excess = v->weight[i] * set->count - 1.0;
        unequal += excess * excess;
        off += squared_distance(set->at[i], v->centroid[i]);
    }
    return sqrt(unequal / set->count) + sqrt(off / set->count);
}
