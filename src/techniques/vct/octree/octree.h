// The sparse voxel octree: bricks of radiance and opacity in place of the mips.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/octree/octree_shared.h"

struct vct_svo {
    gpu_buffer nodes;
    gpu_buffer brick_coords; // of the node of each brick
    gpu_buffer blocks, levels;
    gpu_pipeline mark, count, scan, subdivide, join, mip;
    gpu_pipeline fill[2]; // without and with moving voxels
    struct vct_svo_params params;
};

struct vct_frame;

// Builds the tree over the occupied voxels.
void vct_octree_build(const struct vct_svo *svo, const struct vct_frame *frame);
// From the lit voxels to the bricks of all levels, in the image of the light volume.
void vct_octree_fill(const struct vct_svo *svo, const struct vct_frame *frame);
