// Rows of points inside objects are the mean of the nearest points on their grid that are valid:
// those on the smallest square, or cube, around a point that has one.
#include "techniques/mrt/objects/delta.h"

#include <stdlib.h>
#include <string.h>

// Points on a grid; a wall has one layer.
struct grid {
    int edge, layers, values;
    struct matrix_f32 *rows;
    const bool *inside;
};

static int points_of(const struct grid *grid)
{
    return grid->edge * grid->edge * grid->layers;
}

static float *row_of(const struct grid *grid, int point, int value)
{
    const size_t row = (size_t)point * (size_t)grid->values + (size_t)value;
    return grid->rows->at + row * grid->rows->stride;
}

// Adds the rows of the valid points at this distance; returns their number.
static int add_ring(const struct grid *grid, int to, int distance)
{
    const int n = grid->edge, x = to % n, y = to / n % n, z = to / (n * n);
    int count = 0;
    for (int i = 0; i < points_of(grid); i++) {
        const int dx = abs(i % n - x), dy = abs(i / n % n - y), dz = abs(i / (n * n) - z);
        const int away = dx > dy ? dx : dy;
        if ((away > dz ? away : dz) != distance || grid->inside[i]) continue;
        count++;
        for (int v = 0; v < grid->values; v++)
            for (size_t m = 0; m < grid->rows->columns; m++)
                row_of(grid, to, v)[m] += row_of(grid, i, v)[m];
    }
    return count;
}

void mrt_inpaint(struct matrix_f32 *rows, int edge, int layers, int values, const bool *inside)
{
    const struct grid grid = { edge, layers, values, rows, inside };
    for (int to = 0; to < points_of(&grid); to++) {
        if (!inside[to]) continue;
        for (int v = 0; v < values; v++)
            memset(row_of(&grid, to, v), 0, rows->columns * sizeof(float));
        int count = 0;
        for (int distance = 1; count == 0 && distance < edge; distance++)
            count = add_ring(&grid, to, distance);
        for (int v = 0; count > 0 && v < values; v++)
            for (size_t m = 0; m < rows->columns; m++) row_of(&grid, to, v)[m] /= (float)count;
    }
}
