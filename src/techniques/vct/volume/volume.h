// The light volume: directional radiance and opacity, prefiltered into mips.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/volume/volume_shared.h"

// Occupied texels of a level of the clip map.
struct vct_level_texels {
    gpu_buffer list, mask;
    gpu_buffer counts; // struct vct_texel_levels
};

struct vct_volume {
    gpu_pipeline texels, mip;
    gpu_pipeline fill[2]; // without and with moving voxels
    gpu_sampler linear;
    gpu_image light; // RGBA16F: six volumes side by side with mips, or the octree's pool of bricks.
                     // vctao, mips: R16F
    struct vct_level_texels levels[VCT_MAX_CLIPS];
    bool outdated; // it has texels whose voxels are gone
};

struct vct_frame;

// Lists the texels of a level that hold voxels: only these are filled and filtered.
void vct_volume_list_texels(struct vct_volume *volume, const struct vct_frame *frame, int level);
// From the lit voxels to the light volume and its mips.
void vct_volume_fill(struct vct_volume *volume, const struct vct_frame *frame);
