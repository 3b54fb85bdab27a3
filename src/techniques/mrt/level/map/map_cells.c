// Free cells, and their walls.
#include "map_cells.h"
#include "map_outside.h"

#include "core/host.h"

#include "techniques/mrt/level/holes.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = MRT_FACE_SAMPLES };
static const float ALIGNED = 0.9f; // cosine between a wall's normal and the axis
static const float RELIEF = 0.05f; // of a cell: of a wall, whose objects stand further out
static const float REACH = 0.25f;  // of a cell: surfaces this near to a face belong to it

void mrt_cell_place(const struct mrt_cells *cells, int i, int at[3])
{
    int nx = mrt_cells_along(cells, 0), ny = mrt_cells_along(cells, 1);
    at[0] = i % nx;
    at[1] = i / nx % ny;
    at[2] = i / (nx * ny);
}

bool mrt_cell_beyond(const struct mrt_cells *cells, const int at[3], int face, int out[3])
{
    for (int a = 0; a < 3; a++) out[a] = at[a];
    out[face / 2] += face & 1 ? 1 : -1;
    return out[face / 2] >= 0 && out[face / 2] < mrt_cells_along(cells, face / 2);
}

static float size_along(const struct mrt_cells *cells, const int at[3], int axis)
{
    const float *plane = cells->plane[axis] + at[axis];
    return plane[1] - plane[0];
}

// Sample i of a face's plane, inside the cell by this distance.
static vec3s face_sample(const struct mrt_cells *cells, const int at[3], int face, float inside,
                         int i)
{
    int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    vec3s p;
    p.raw[u] = cells->plane[u][at[u]] +
               size_along(cells, at, u) * ((float)(i % SAMPLES) + 0.5f) / (float)SAMPLES;
    p.raw[v] = cells->plane[v][at[v]] +
               size_along(cells, at, v) * ((float)(i / SAMPLES) + 0.5f) / (float)SAMPLES;
    p.raw[axis] = cells->plane[axis][at[axis] + (face & 1)] + (face & 1 ? -inside : inside);
    return p;
}

static vec3s outward(int face)
{
    vec3s d = vec3_of(0, 0, 0);
    d.raw[face / 2] = face & 1 ? 1.0f : -1.0f;
    return d;
}

static bool is_blocked(const struct mrt_cells *cells, const int at[3], int face,
                       const int beyond[3], int i)
{
    const float inside = REACH * size_along(cells, at, face / 2);
    const float outside = REACH * size_along(cells, beyond, face / 2);
    return raycast_blocked(cells->raycast, face_sample(cells, at, face, inside, i), outward(face),
                           inside + outside);
}

bool mrt_cells_is_air(const struct mrt_cells *cells, const int at[3], int face, const int beyond[3],
                      int u, int v)
{
    const int i = v * SAMPLES + u;
    if (is_blocked(cells, at, face, beyond, i)) return false;
    return !mrt_is_in_solid(cells, face_sample(cells, at, face, 0.0f, i));
}

static float open_share(const struct mrt_cells *cells, const int at[3], int face,
                        const int beyond[3])
{
    int open = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) open += !is_blocked(cells, at, face, beyond, i);
    return (float)open / (float)(SAMPLES * SAMPLES);
}

static void find_openings(struct mrt_cells *cells)
{
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        int at[3], beyond[3];
        mrt_cell_place(cells, i, at);
        for (int face = 0; face < CUBE_FACES; face++) {
            bool inside = mrt_cell_beyond(cells, at, face, beyond);
            if (inside && !(face & 1)) continue; // each pair of cells once
            const float share = open_share(cells, at, face, inside ? beyond : at);
            if (share >= MRT_LEAST_OPENING) {
                cells->cell[i].open |= 1u << face;
                if (inside) mrt_cell_at(cells, beyond)->open |= 1u << cube_opposite(face);
            } else if (inside && share >= MRT_LEAST_HOLE) {
                cells->cell[i].hole |= 1u << face;
                mrt_cell_at(cells, beyond)->hole |= 1u << cube_opposite(face);
            }
        }
    }
}

static void free_cell_of(struct mrt_cells *cells, vec3s seed)
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        const float *plane = cells->plane[a];
        if (!(seed.raw[a] >= plane[0] && seed.raw[a] <= plane[cells->planes[a] - 1])) return;
        for (at[a] = 0; at[a] + 1 < mrt_cells_along(cells, a); at[a]++)
            if (seed.raw[a] < plane[at[a] + 1]) break;
    }
    struct mrt_cell *cell = mrt_cell_at(cells, at);
    cell->free = !cell->outside && !cell->solid;
}

static bool has_free_neighbor(const struct mrt_cells *cells, int i)
{
    int at[3], beyond[3];
    mrt_cell_place(cells, i, at);
    for (int f = 0; f < CUBE_FACES; f++)
        if ((cells->cell[i].open | cells->cell[i].hole) >> f & 1u &&
            mrt_cell_beyond(cells, at, f, beyond) && mrt_cell_at(cells, beyond)->free)
            return true;
    return false;
}

static void flood(struct mrt_cells *cells)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (int i = 0; i < mrt_cells_count(cells); i++) {
            const struct mrt_cell *cell = &cells->cell[i];
            if (cell->free || cell->outside || cell->solid) continue;
            if (!has_free_neighbor(cells, i)) continue;
            cells->cell[i].free = changed = true;
        }
    }
}

// Frees the cells that are connected with the seeds. Returns whether there is one.
static bool free_cells(struct mrt_cells *cells, const vec3s *seeds, size_t count)
{
    for (size_t i = 0; i < count; i++) free_cell_of(cells, seeds[i]);
    flood(cells);
    for (int i = 0; i < mrt_cells_count(cells); i++)
        if (cells->cell[i].free) return true;
    return false;
}

bool mrt_cells_fill(struct host *host, struct mrt_cells *cells, const vec3s *seeds, size_t count)
{
    host_free(host, cells->cell);
    cells->cell = host_alloc(host, (size_t)mrt_cells_count(cells), sizeof *cells->cell);
    if (!cells->cell) return false;
    find_openings(cells);
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        int at[3];
        mrt_cell_place(cells, i, at);
        cells->cell[i].outside = mrt_cell_is_outside(cells, at);
        cells->cell[i].solid = !cells->cell[i].outside && mrt_cell_is_solid(cells, at);
    }
    if (free_cells(cells, seeds, count)) return true;
    // A room whose surfaces all show their backs to it is no solid.
    for (int i = 0; i < mrt_cells_count(cells); i++) cells->cell[i].solid = false;
    free_cells(cells, seeds, count);
    return true;
}

// ---- snapping

struct wall_distance {
    float sum;
    int hits;
};

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Surfaces near a closed face of a free cell, as seen from inside. Objects before a wall without
// openings are less than half of what is seen: only what is near the median belongs to it. Before
// an arcade nothing tells them from its relief: all counts.
static void add_wall(const struct mrt_cells *cells, const int at[3], int face,
                     struct wall_distance *wall)
{
    int axis = face / 2;
    float inside = REACH * size_along(cells, at, axis), place[SAMPLES * SAMPLES];
    int hits = 0;
    bool closed = true;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        struct raycast_hit hit;
        vec3s from = face_sample(cells, at, face, inside, i);
        if (!raycast_closest(cells->raycast, from, outward(face), 2.0f * inside, &hit)) {
            closed = false;
            continue;
        }
        // Backs are seen from inside a wall.
        if (!hit.front || fabsf(hit.normal.raw[axis]) < ALIGNED) continue;
        place[hits++] = from.raw[axis] + (face & 1 ? hit.distance : -hit.distance);
    }
    if (hits == 0) return;
    qsort(place, (size_t)hits, sizeof *place, ascending);
    const float relief = RELIEF * size_along(cells, at, axis), median = place[hits / 2];
    for (int i = 0; i < hits; i++) {
        if (closed && fabsf(place[i] - median) > relief) continue;
        wall->sum += place[i];
        wall->hits++;
    }
}

static float snapped(const struct mrt_cells *cells, int axis, int plane)
{
    struct wall_distance wall[2] = { 0 }; // from below, from above
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        int at[3];
        mrt_cell_place(cells, i, at);
        if (!cells->cell[i].free) continue;
        for (int above = 0; above < 2; above++) {
            int face = 2 * axis + !above;
            if (at[axis] + !above != plane || cells->cell[i].open >> face & 1u) continue;
            add_wall(cells, at, face, &wall[above]);
        }
    }
    float sum = 0.0f;
    int sides = 0;
    for (int s = 0; s < 2; s++) {
        if (wall[s].hits == 0) continue;
        sum += wall[s].sum / (float)wall[s].hits;
        sides++;
    }
    return sides ? sum / (float)sides : cells->plane[axis][plane];
}

// Rays that an object hides change the last bits of a plane: it is at a multiple of 2⁻¹⁸ of the
// power of two above the shortest edge of the bounds.
static float rounded(const struct mrt_cells *cells, float position)
{
    int exponent;
    frexpf(glms_vec3_min(box3_size(cells->bounds)), &exponent);
    return ldexpf(roundf(ldexpf(position, 18 - exponent)), exponent - 18);
}

void mrt_cells_snap(struct mrt_cells *cells)
{
    float moved[3][MRT_MAX_PLANES];
    for (int a = 0; a < 3; a++)
        for (int p = 0; p < cells->planes[a]; p++)
            moved[a][p] = rounded(cells, snapped(cells, a, p));
    for (int a = 0; a < 3; a++)
        for (int p = 0; p < cells->planes[a]; p++) cells->plane[a][p] = moved[a][p];
}
