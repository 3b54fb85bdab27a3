// Rows of points inside objects are the mean of the nearest points on their grid that are valid:
// those on the smallest square, or cube, around a point that has one.
#include "techniques/mrt/clutter/delta.h"

#include "techniques/mrt/level/probes.h"

#include <stdlib.h>
#include <string.h>

// Points on a grid; a wall has one layer.
struct grid {
    int size[3];
    size_t first; // point
    int values;
    struct matrix_f32 *rows;
    const bool *inside; // of all points
};

static float *row_of(const struct grid *grid, int point, int value)
{
    const size_t row = (grid->first + (size_t)point) * (size_t)grid->values + (size_t)value;
    return grid->rows->at + row * grid->rows->stride;
}

// Adds the rows of the valid points at this distance; returns their number.
static int add_ring(const struct grid *grid, int to, int distance)
{
    const int *size = grid->size;
    const int x = to % size[0], y = to / size[0] % size[1], z = to / (size[0] * size[1]);
    int count = 0;
    for (int i = 0; i < size[0] * size[1] * size[2]; i++) {
        const int dx = abs(i % size[0] - x), dy = abs(i / size[0] % size[1] - y);
        const int dz = abs(i / (size[0] * size[1]) - z);
        const int away = dx > dy ? dx : dy;
        if ((away > dz ? away : dz) != distance || grid->inside[grid->first + (size_t)i]) continue;
        count++;
        for (int v = 0; v < grid->values; v++)
            for (size_t m = 0; m < grid->rows->columns; m++)
                row_of(grid, to, v)[m] += row_of(grid, i, v)[m];
    }
    return count;
}

static void inpaint(const struct grid *grid)
{
    const int *size = grid->size;
    const int most = size[0] > size[2] ? size[0] : size[2];
    for (int to = 0; to < size[0] * size[1] * size[2]; to++) {
        if (!grid->inside[grid->first + (size_t)to]) continue;
        for (int v = 0; v < grid->values; v++)
            memset(row_of(grid, to, v), 0, grid->rows->columns * sizeof(float));
        int count = 0;
        for (int distance = 1; count == 0 && distance < most; distance++)
            count = add_ring(grid, to, distance);
        for (int v = 0; count > 0 && v < grid->values; v++)
            for (size_t m = 0; m < grid->rows->columns; m++) row_of(grid, to, v)[m] /= (float)count;
    }
}

void mrt_inpaint_texels(struct matrix_f32 *rows, int resolution, int walls, int values,
                        const bool *inside)
{
    for (int w = 0; w < walls; w++) {
        const struct grid grid = { .size = { resolution, resolution, 1 },
                                   .first = (size_t)(w * resolution * resolution),
                                   .values = values,
                                   .rows = rows,
                                   .inside = inside };
        inpaint(&grid);
    }
}

void mrt_inpaint_probes(struct matrix_f32 *rows, int p, const bool *inside)
{
    const struct grid grid = {
        .size = { p, p, p }, .values = MRT_PROBE_VALUES, .rows = rows, .inside = inside
    };
    inpaint(&grid);
}
