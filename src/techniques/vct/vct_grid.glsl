// The uniform block of a grid, and indices of its voxels and texels. Binding: VCT_GRID_BINDING, 13
// unless defined before.
#ifndef AG_VCT_GRID_GLSL
#define AG_VCT_GRID_GLSL

#include "techniques/vct/vct_shared.h"

#ifndef VCT_GRID_BINDING
#define VCT_GRID_BINDING 13
#endif

#ifdef VCT_GRID_COPIED
layout(set = 0, binding = VCT_GRID_BINDING, scalar) uniform vct_grid
{
    vct_params vct_block;
};
vct_params vct; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
#else
layout(set = 0, binding = VCT_GRID_BINDING, scalar) uniform vct_grid
{
    vct_params vct;
};
#endif

ivec3 vct_cells()
{
    return ivec3(vct.cells_x, vct.cells_y, vct.cells_z);
}

bool vct_inside(ivec3 voxel)
{
    return all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, vct_cells()));
}

// A texel has 2 × 2 × 2 voxels. x varies fastest.
uint vct_texel_index(ivec3 texel)
{
    return uint((texel.z * vct.volume_dim + texel.y) * vct.volume_dim + texel.x);
}

ivec3 vct_texel(uint index)
{
    uint dim = uint(vct.volume_dim);
    return ivec3(index % dim, index / dim % dim, index / (dim * dim));
}

// The eight voxels of a texel are consecutive: one byte of a mask.
uint vct_index(ivec3 voxel)
{
    ivec3 low = voxel & 1;
    return 8u * vct_texel_index(voxel >> 1) + uint(low.x | low.y << 1 | low.z << 2);
}

ivec3 vct_voxel(uint index)
{
    return 2 * vct_texel(index / 8u) + (ivec3(index) >> ivec3(0, 1, 2) & 1);
}

ivec3 vct_unpack_texel(uint packed)
{
    return ivec3(packed & 1023u, packed >> 10 & 1023u, packed >> 20);
}

uint vct_pack_texel(ivec3 texel)
{
    return uint(texel.x | texel.y << 10 | texel.z << 20);
}

// A voxel has six faces: the surfaces whose outward normal is nearest to +x −x +y −y +z −z. Faces
// are the units of occupancy, surfaces and light; a byte of a mask is a voxel.
const uint VCT_FACES = 6u;

uint vct_face_index(ivec3 voxel, uint face)
{
    return 8u * vct_index(voxel) + face;
}

ivec3 vct_voxel_of_face(uint index)
{
    return vct_voxel(index / 8u);
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
