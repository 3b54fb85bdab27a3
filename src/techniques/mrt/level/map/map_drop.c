// Planes that separate nothing are dropped, planes that keep blocks near cubes are added.
#include "map_cells.h"

#include "core/saturate.h"

#include <math.h>

static bool is_cubic(const struct mrt_cells *cells, const int at[3], int axis, float max_aspect)
{
    float shortest = INFINITY, longest = 0.0f;
    for (int a = 0; a < 3; a++) {
        const float *plane = cells->plane[a] + at[a];
        float edge = plane[a == axis ? 2 : 1] - plane[0];
        shortest = fminf(shortest, edge);
        longest = fmaxf(longest, edge);
    }
    return longest <= max_aspect * shortest;
}

// Whether the cells on both sides of the plane are one in every respect.
static bool separates(const struct mrt_cells *cells, int axis, int plane, float max_aspect)
{
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        int at[3], beyond[3];
        mrt_cell_place(cells, i, at);
        if (at[axis] != plane - 1) continue;
        int face = 2 * axis + 1;
        mrt_cell_beyond(cells, at, face, beyond);
        const struct mrt_cell *low = &cells->cell[i], *high = mrt_cell_at(cells, beyond);
        if (low->free != high->free) return true;
        if (!low->free) continue;
        unsigned sides = CUBE_ALL_FACES & ~(3u << (face & ~1));
        if (!(low->open >> face & 1u) || (low->open ^ high->open) & sides) return true;
        if (!is_cubic(cells, at, axis, max_aspect)) return true;
    }
    return false;
}

// Cells above the plane are dropped; those below get their openings at the far end.
static void drop(struct mrt_cells *cells, int axis, int plane)
{
    struct mrt_cells old = *cells;
    unsigned end = 1u << (2 * axis + 1);
    int kept = 0;
    for (int i = 0; i < mrt_cells_count(&old); i++) {
        int at[3], beyond[3];
        mrt_cell_place(&old, i, at);
        if (at[axis] == plane) continue;
        struct mrt_cell cell = old.cell[i];
        if (at[axis] == plane - 1) {
            mrt_cell_beyond(&old, at, 2 * axis + 1, beyond);
            cell.open = (cell.open & ~end) | (mrt_cell_at(&old, beyond)->open & end);
            cell.hole = (cell.hole & ~end) | mrt_cell_at(&old, beyond)->hole;
        }
        cells->cell[kept++] = cell; // never beyond i: cells ahead are unchanged
    }
    cells->planes[axis]--;
    for (int p = plane; p < cells->planes[axis]; p++)
        cells->plane[axis][p] = cells->plane[axis][p + 1];
}

void mrt_cells_drop_planes(struct mrt_cells *cells, float max_aspect)
{
    for (int axis = 0; axis < 3; axis++)
        for (int p = cells->planes[axis] - 2; p > 0; p--)
            if (!separates(cells, axis, p, max_aspect)) drop(cells, axis, p);
}

// ---- thick walls

// Greatest thickness, of the cells on either side.
static const float THICK = 0.2f;

static bool is_wall(const struct mrt_cells *cells, int axis, int plane)
{
    const float *at = cells->plane[axis] + plane;
    if (at[1] - at[0] > THICK * fminf(at[0] - at[-1], at[2] - at[1])) return false;
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        int place[3];
        mrt_cell_place(cells, i, place);
        if (place[axis] != plane || !cells->cell[i].free) continue;
        if (cells->cell[i].open >> 2 * axis & 3u) return false;
    }
    return true;
}

bool mrt_cells_join_walls(struct mrt_cells *cells)
{
    bool any = false;
    for (int axis = 0; axis < 3; axis++)
        for (int p = cells->planes[axis] - 3; p > 0; p--) {
            if (!is_wall(cells, axis, p)) continue;
            const float middle = 0.5f * (cells->plane[axis][p] + cells->plane[axis][p + 1]);
            drop(cells, axis, p + 1);
            cells->plane[axis][p] = middle;
            any = true;
        }
    return any;
}

// ---- long cells

// Pieces of the cells between two planes: their length over the mean width, weighted by volume.
static int pieces_between(const struct mrt_cells *cells, int axis, int plane)
{
    float length = cells->plane[axis][plane + 1] - cells->plane[axis][plane];
    float volumes = 0.0f, sum = 0.0f;
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        int at[3];
        mrt_cell_place(cells, i, at);
        if (at[axis] != plane || !cells->cell[i].free) continue;
        float area = 1.0f;
        for (int a = 0; a < 3; a++)
            if (a != axis) area *= cells->plane[a][at[a] + 1] - cells->plane[a][at[a]];
        volumes += area;
        sum += area * sqrtf(area);
    }
    return int_saturated((double)(length * volumes / sum + 0.5f), 1, MRT_MAX_PLANES);
}

void mrt_cells_split(struct mrt_cells *cells)
{
    int pieces[3][MRT_MAX_PLANES];
    for (int axis = 0; axis < 3; axis++)
        for (int p = 0; p + 1 < cells->planes[axis]; p++)
            pieces[axis][p] = pieces_between(cells, axis, p);
    for (int axis = 0; axis < 3; axis++) {
        float old[MRT_MAX_PLANES];
        int count = cells->planes[axis], left = MRT_MAX_PLANES - count;
        for (int p = 0; p < count; p++) old[p] = cells->plane[axis][p];
        cells->planes[axis] = 0;
        for (int p = 0; p < count; p++) {
            cells->plane[axis][cells->planes[axis]++] = old[p];
            int parts = p + 1 < count ? pieces[axis][p] : 1;
            if (parts - 1 > left) parts = left + 1;
            for (int k = 1; k < parts; k++, left--)
                cells->plane[axis][cells->planes[axis]++] =
                    old[p] + (old[p + 1] - old[p]) * (float)k / (float)parts;
        }
    }
}
