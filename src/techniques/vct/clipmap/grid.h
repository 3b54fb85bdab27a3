// Placement of voxel grids. Pure CPU.
#pragma once

#include "scene/pose.h"

struct vct_grid {
    vec3s origin_m; // corner of voxel 0, world space
    float cell_m;
    int32_t cells[3]; // in use, even
    // In voxels of this grid: offset from the corner of the scene's grid, and extent of that grid.
    int32_t first[3], scene[3];
};

// Cubic voxels over `bounds`, at most `dim` along the longest side. Their size is a power of
// 2^(1/16) m and the corner of the grid is a multiple of two voxels, so that motion at the border
// of the scene seldom moves the grid. False if the bounds have no extent.
bool vct_grid_fit(struct box3 bounds, int dim, struct vct_grid *out);

// Clip-map grid around `camera`: at most `dim` voxels per axis, of the scene's voxel size halved
// `halvings` times. It lies within the scene's grid, its corner is on a texel border of the next
// coarser grid, and it moves in steps of some voxels.
struct vct_grid vct_grid_around(const struct vct_grid *scene, int dim, int halvings, vec3s camera);
// Box in which cones sample that grid, in its voxels from the scene's corner. It moves continuously
// with the camera and lies within the grid; on the border of the scene it extends beyond it by at
// least `fade` voxels.
struct box3 vct_grid_cone_box(const struct vct_grid *scene, int dim, int halvings, vec3s camera,
                              float fade);
