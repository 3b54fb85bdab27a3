// The grid's uniform block and where things lie in it. Binding: VCT_GRID_BINDING, 13 unless defined before.
#ifndef AG_VCT_GRID_GLSL
#define AG_VCT_GRID_GLSL

#include "techniques/vct/vct_shared.h"

#ifndef VCT_GRID_BINDING
#define VCT_GRID_BINDING 13
#endif

layout(set = 0, binding = VCT_GRID_BINDING, scalar) uniform vct_grid
{
    vct_params vct;
};

ivec3 vct_cells()
{
    return ivec3(vct.cells_x, vct.cells_y, vct.cells_z);
}

bool vct_inside(ivec3 voxel)
{
    return all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, vct_cells()));
}

uint vct_index(ivec3 voxel)
{
    return uint((voxel.z * vct.dim + voxel.y) * vct.dim + voxel.x);
}

ivec3 vct_voxel(uint index)
{
    uint dim = uint(vct.dim);
    return ivec3(index % dim, index / dim % dim, index / (dim * dim));
}

// Position in voxels from the grid's corner.
vec3 vct_voxels_from_world(vec3 position)
{
    return (position - vct.origin_m) * vct.cells_per_m;
}

vec3 vct_world_from_voxels(vec3 at)
{
    return vct.origin_m + at * vct.cell_m;
}

const uint VCT_NO_SLOT = 0xffffffffu;

#endif
