// Cells between axis-aligned planes: the decomposition of a scene's free space that mrt_map_auto
// merges into boxes.
#pragma once

#include "scene/view/raycast.h"

#include "techniques/mrt/dictionary/cube.h"

enum { MRT_MAX_PLANES = 11 }; // per axis, with the two of the bounds: at most 1000 cells

struct mrt_cell {
    bool outside;  // open to the sky rather than enclosed
    bool solid;    // inside of a wall or an object
    bool free;     // connected with a seed, and neither outside nor solid
    unsigned open; // bit f: nothing separates it from what is beyond face f
    unsigned hole; // bit f: a wall with holes, such as a door, does
};

struct mrt_regions;

struct mrt_cells {
    struct raycast *raycast;
    struct box3 bounds;
    float reach_m; // surfaces farther away enclose nothing: mrt_roof_reach of the scene
    // Enclosed regions of the scene. NULL: the cells are those of one region.
    const struct mrt_regions *regions;
    float plane[3][MRT_MAX_PLANES]; // ascending
    int planes[3];
    struct mrt_cell *cell; // x fastest
};

// Planes where the scene has large surfaces of one axis, the bounds included.
void mrt_cells_find_planes(struct mrt_cells *cells);
// Allocates the cells and finds open faces and free cells.
bool mrt_cells_fill(struct host *host, struct mrt_cells *cells, const vec3s *seeds, size_t count);
// Moves the planes to the walls, as seen from the free cells on either side.
void mrt_cells_snap(struct mrt_cells *cells);

enum { MRT_FACE_SAMPLES = 8 }; // along each edge of a face

// Whether neither a surface nor a solid is at place (u, v) of the face between two cells; u and v
// are the axes after that of the face.
bool mrt_cells_is_air(const struct mrt_cells *cells, const int at[3], int face, const int beyond[3],
                      int u, int v);

// Removes planes of objects, which leave air above or beside them, from between free cells. The
// cells must be filled again where it returns true.
bool mrt_cells_drop_objects(struct mrt_cells *cells);

// Makes one plane of the two sides of a thick wall, whose cells light enters by holes alone, if at
// all. The cells must be filled again where it returns true.
bool mrt_cells_join_walls(struct mrt_cells *cells);

// Removes planes that separate nothing, while edges of free cells stay below this ratio.
void mrt_cells_drop_planes(struct mrt_cells *cells, float max_aspect);

// Adds planes across free cells that are long, so that the pieces come near to cubes. The cells
// must be filled again.
void mrt_cells_split(struct mrt_cells *cells);

static inline int mrt_cells_along(const struct mrt_cells *cells, int axis)
{
    return cells->planes[axis] - 1;
}

static inline int mrt_cells_count(const struct mrt_cells *cells)
{
    return mrt_cells_along(cells, 0) * mrt_cells_along(cells, 1) * mrt_cells_along(cells, 2);
}

static inline struct mrt_cell *mrt_cell_at(const struct mrt_cells *cells, const int at[3])
{
    int nx = mrt_cells_along(cells, 0), ny = mrt_cells_along(cells, 1);
    return &cells->cell[(at[2] * ny + at[1]) * nx + at[0]];
}

// Coordinates of cell i; the coordinates beyond a face, false outside.
void mrt_cell_place(const struct mrt_cells *cells, int i, int at[3]);
bool mrt_cell_beyond(const struct mrt_cells *cells, const int at[3], int face, int out[3]);
