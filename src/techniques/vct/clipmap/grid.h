// Where the voxels lie. Pure CPU.
#pragma once

#include "scene/pose.h"

struct vct_grid {
    vec3s origin_m; // corner of voxel 0, world space
    float cell_m;
    int32_t cells[3]; // in use, even
    // Of a part of the scene's grid, in voxels of its own: where it begins in it, and how many that
    // one has.
    int32_t first[3], scene[3];
};

// Cubic voxels over `bounds`, `dim` along the longest side and fewer along the others. Their size
// is a power of 2^(1/16) m and their corners are multiples of two of them, so that what moves at
// the scene's edge seldom moves the grid. False where there is nothing to put voxels over.
bool vct_grid_fit(struct box3 bounds, int dim, struct vct_grid *out);

// The part about `eye` of the grid over a scene, `dim` voxels wide, which are halved `halvings`
// times. It lies within the scene's grid, begins on the border of a texel of the next coarser part,
// and stays where it is while the eye moves by less than some voxels.
struct vct_grid vct_grid_around(const struct vct_grid *scene, int dim, int halvings, vec3s eye);
// What of it cones look into, in its voxels from the scene's corner. It moves with the eye, not in
// steps, and always is within it; where it reaches the border of the scene it ends beyond that by
// `fade` voxels at least.
struct box3 vct_grid_cone_box(const struct vct_grid *scene, int dim, int halvings, vec3s eye,
                              float fade);
