// Rays through the faces of voxels: an alternative to marching cones.
#pragma once

#include "frame/frame.h"

struct vct;
struct vct_clip;

// Occupancy of a grid whose texels are listed.
void vct_rays_list_blocks(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd);
