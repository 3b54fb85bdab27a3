// The uniform block of the grid (binding 0) and coordinates in the grid. With LPV_GRID_COPIED,
// `lpv` is a copy that main begins with, as with FRAME_CONSTANTS_COPIED: lpv = lpv_block.
#ifndef AG_LPV_GRID_GLSL
#define AG_LPV_GRID_GLSL

#include "techniques/lpv/lpv_shared.h"

#ifdef LPV_GRID_COPIED
layout(set = 0, binding = 0, scalar) uniform lpv_grid
{
    lpv_params lpv_block;
};
lpv_params lpv;
#else
layout(set = 0, binding = 0, scalar) uniform lpv_grid
{
    lpv_params lpv;
};
#endif

ivec3 lpv_cells()
{
    return ivec3(lpv.cells_x, lpv.cells_y, lpv.cells_z);
}

bool lpv_inside(ivec3 cell)
{
    return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, lpv_cells()));
}

// Position in cells from the grid's corner.
vec3 lpv_cells_from_world(vec3 position)
{
    return (position - lpv.origin_m) / lpv.cell_m;
}

// Whether the cell is an outermost one on one of the sides (LPV_OPEN bits).
bool lpv_outermost(ivec3 cell, uint sides)
{
    ivec3 last = lpv_cells() - 1;
    for (int axis = 0; axis < 3; axis++) {
        if ((sides & LPV_OPEN(axis, 0)) != 0u && cell[axis] == 0) return true;
        if ((sides & LPV_OPEN(axis, 1)) != 0u && cell[axis] == last[axis]) return true;
    }
    return false;
}

// First cell of an invocation that takes `run` cells along z (lpv_dispatch_cells); may be outside
// of the grid.
ivec3 lpv_cell_of_invocation(int run)
{
    int column = int(gl_GlobalInvocationID.x), row = column / lpv.cells_x;
    return ivec3(column % lpv.cells_x, row % lpv.cells_y, row / lpv.cells_y * run);
}

int lpv_index(ivec3 cell)
{
    return (cell.z * lpv.cells_y + cell.y) * lpv.cells_x + cell.x;
}

#endif
