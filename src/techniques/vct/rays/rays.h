// Rays through the faces of voxels: an alternative to marching cones.
#pragma once

#include "frame/frame.h"

struct vct_rays {
    gpu_pipeline planes, blocks;
    gpu_image block_image;    // RGBA32U, of all levels along z: see rays_shared.h
    gpu_image first_slots[2]; // R32U, of each block and set
};

struct vct_frame;

// Planes of the faces and occupancy of a level, whose texels are listed.
void vct_rays_list_blocks(const struct vct_rays *rays, const struct vct_frame *frame, int level);
