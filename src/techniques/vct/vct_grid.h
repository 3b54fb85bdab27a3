// Where the voxels lie. Pure CPU.
#pragma once

#include "scene/pose.h"

struct vct_grid {
    vec3s origin_m; // corner of voxel 0, world space
    float cell_m;
    int32_t cells[3]; // in use, even
};

// Cubic voxels over `bounds`, `dim` along the longest side and fewer along the others. Their size
// is a power of 2^(1/16) m and their corners are multiples of two of them, so that what moves at
// the scene's edge seldom moves the grid. False where there is nothing to put voxels over.
bool vct_grid_fit(struct box3 bounds, int dim, struct vct_grid *out);
