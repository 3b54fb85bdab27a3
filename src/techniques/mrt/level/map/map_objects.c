// Planes of furniture and other objects in rooms.
#include "map_cells.h"

#include "techniques/mrt/level/holes.h"

enum { MAX_ALONG = MRT_MAX_PLANES - 1, MAX_PAIRS = MAX_ALONG * MAX_ALONG };

// Pairs of cells on the two sides of a plane: u and v are the axes after its own.
struct pairs {
    const struct mrt_cells *cells;
    int axis, plane, u, v;
    int room[MAX_PAIRS]; // −1: none; pairs of one room share the number
    // Bit i: the line along u, or v, at place i of a face meets surfaces from end to end.
    unsigned blocked[2][MAX_PAIRS];
};
enum { ALL_LINES = (1 << MRT_FACE_SAMPLES) - 1 };

static void place_of(const struct pairs *pairs, int u, int v, bool above, int at[3])
{
    at[pairs->axis] = pairs->plane - !above;
    at[pairs->u] = u;
    at[pairs->v] = v;
}

static const struct mrt_cell *cell_of(const struct pairs *pairs, int u, int v, bool above)
{
    int at[3];
    place_of(pairs, u, v, above, at);
    return mrt_cell_at(pairs->cells, at);
}

static int pair_at(int u, int v)
{
    return v * MAX_ALONG + u;
}

// Marks lines that meet surfaces. Between a room and another place than a solid all do.
static void find_blocked(struct pairs *pairs, int u, int v)
{
    const struct mrt_cell *low = cell_of(pairs, u, v, false), *high = cell_of(pairs, u, v, true);
    const bool ends = (low->free != high->free) && !low->solid && !high->solid;
    unsigned free_lines[2] = { 0, 0 };
    int at[3], beyond[3];
    place_of(pairs, u, v, false, at);
    place_of(pairs, u, v, true, beyond);
    for (int i = 0; !ends && i < MRT_FACE_SAMPLES * MRT_FACE_SAMPLES; i++) {
        const int x = i % MRT_FACE_SAMPLES, y = i / MRT_FACE_SAMPLES;
        const int face = 2 * pairs->axis + 1;
        if (!mrt_cells_is_air(pairs->cells, at, face, beyond, x, y)) continue;
        free_lines[0] |= 1u << y;
        free_lines[1] |= 1u << x;
    }
    for (int k = 0; k < 2; k++) pairs->blocked[k][pair_at(u, v)] = ALL_LINES & ~free_lines[k];
}

// Whether a free cell on the same side of both pairs is open to the other one.
static bool are_joined(const struct pairs *pairs, int u, int v, int axis)
{
    const bool along_u = axis == pairs->u;
    for (int above = 0; above < 2; above++) {
        const struct mrt_cell *a = cell_of(pairs, u, v, above);
        const struct mrt_cell *b = cell_of(pairs, u + along_u, v + !along_u, above);
        if (a->free && b->free && a->open >> (2 * axis + 1) & 1u) return true;
    }
    return false;
}

static bool join(struct pairs *pairs, int from, int to)
{
    const int a = pairs->room[from], b = pairs->room[to];
    if (a == b) return false;
    pairs->room[from] = pairs->room[to] = a < b ? a : b;
    return true;
}

// Numbers the rooms on the plane's two sides. Returns whether there are any.
static bool find_rooms(struct pairs *pairs)
{
    bool any_room = false;
    const int along_u = mrt_cells_along(pairs->cells, pairs->u);
    const int along_v = mrt_cells_along(pairs->cells, pairs->v);
    for (int v = 0; v < along_v; v++)
        for (int u = 0; u < along_u; u++) {
            const bool any = cell_of(pairs, u, v, false)->free || cell_of(pairs, u, v, true)->free;
            pairs->room[pair_at(u, v)] = any ? pair_at(u, v) : -1;
            if (any) find_blocked(pairs, u, v);
            any_room |= any;
        }
    for (bool changed = true; changed;) {
        changed = false;
        for (int v = 0; v < along_v; v++)
            for (int u = 0; u < along_u; u++) {
                const int here = pair_at(u, v);
                if (u + 1 < along_u && are_joined(pairs, u, v, pairs->u))
                    changed |= join(pairs, here, pair_at(u + 1, v));
                if (v + 1 < along_v && are_joined(pairs, u, v, pairs->v))
                    changed |= join(pairs, here, pair_at(u, v + 1));
            }
    }
    return any_room;
}

// The lines through a pair along an axis that are blocked in all pairs of its room.
static unsigned full_lines(const struct pairs *pairs, int u, int v, int axis)
{
    const int room = pairs->room[pair_at(u, v)], along = mrt_cells_along(pairs->cells, axis);
    unsigned lines = ALL_LINES;
    for (int i = 0; i < along; i++) {
        const int at = axis == pairs->u ? pair_at(i, v) : pair_at(u, i);
        if (pairs->room[at] == room) lines &= pairs->blocked[axis != pairs->u][at];
    }
    return lines;
}

static float edge_of(const struct pairs *pairs, int axis, int i)
{
    const float *plane = pairs->cells->plane[axis] + i;
    return plane[1] - plane[0];
}

static bool is_closed(const struct pairs *pairs, int u, int v)
{
    const struct mrt_cell *low = cell_of(pairs, u, v, false), *high = cell_of(pairs, u, v, true);
    return low->free != high->free || !(low->open >> (2 * pairs->axis + 1) & 1u);
}

// Whether a wall is between the plane's two sides: it closes half of a room, or spans it along one
// axis, such as an arcade by its parapet. An object leaves air above or below it and beside it.
static bool is_wall(const struct pairs *pairs)
{
    float area[MAX_PAIRS] = { 0 }, closed[MAX_PAIRS] = { 0 };
    for (int v = 0; v < mrt_cells_along(pairs->cells, pairs->v); v++)
        for (int u = 0; u < mrt_cells_along(pairs->cells, pairs->u); u++) {
            const int room = pairs->room[pair_at(u, v)];
            if (room < 0) continue;
            if (full_lines(pairs, u, v, pairs->u) || full_lines(pairs, u, v, pairs->v)) return true;
            const float here = edge_of(pairs, pairs->u, u) * edge_of(pairs, pairs->v, v);
            area[room] += here;
            closed[room] += is_closed(pairs, u, v) ? here : 0.0f;
        }
    for (int i = 0; i < MAX_PAIRS; i++)
        if (closed[i] > (1.0f - MRT_LEAST_OPENING) * area[i]) return true;
    return false;
}

static bool is_of_objects(const struct mrt_cells *cells, int axis, int plane)
{
    struct pairs pairs = {
        .cells = cells, .axis = axis, .plane = plane, .u = (axis + 1) % 3, .v = (axis + 2) % 3
    };
    return find_rooms(&pairs) && !is_wall(&pairs);
}

static bool drop_marked(struct mrt_cells *cells, int axis, const bool *marked)
{
    const int count = cells->planes[axis];
    cells->planes[axis] = 0;
    for (int p = 0; p < count; p++)
        if (!marked[p]) cells->plane[axis][cells->planes[axis]++] = cells->plane[axis][p];
    return cells->planes[axis] < count;
}

bool mrt_cells_drop_objects(struct mrt_cells *cells)
{
    bool marked[3][MRT_MAX_PLANES] = { 0 }, any = false;
    for (int axis = 0; axis < 3; axis++)
        for (int p = 1; p + 1 < cells->planes[axis]; p++)
            marked[axis][p] = is_of_objects(cells, axis, p);
    for (int axis = 0; axis < 3; axis++) any |= drop_marked(cells, axis, marked[axis]);
    return any;
}
