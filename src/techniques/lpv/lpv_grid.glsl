// The grid's uniform block and where things lie in it. Binding 0.
#ifndef AG_LPV_GRID_GLSL
#define AG_LPV_GRID_GLSL

#include "techniques/lpv/lpv_shared.h"

layout(set = 0, binding = 0, scalar) uniform lpv_grid
{
    lpv_params lpv;
};

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

int lpv_index(ivec3 cell)
{
    return (cell.z * lpv.cells_y + cell.y) * lpv.cells_x + cell.x;
}

#endif
