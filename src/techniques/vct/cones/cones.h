// Diffuse cones of the pixels: tracing, gathering from neighbours, upsampling.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cone_sets.h"
#include "techniques/vct/cones/cones_shared.h"

// Images of traced pixels, of one view at a time.
struct vct_pixels {
    uint32_t width, height;
    gpu_image edge_image;             // R8: discontinuities
    gpu_image cone_normal_image;      // RG16F: octahedral, axis of each pixel's cone set
    gpu_image traced[3], gathered[3]; // RGBA16F: cone sums of each colour
    gpu_image gathered_irradiance;    // RGBA16F: irradiance, fraction of the cone set
};

struct vct_cones {
    gpu_pipeline trace[4];                          // by vct_light_variant
    gpu_pipeline gather_rows[2], gather_columns[2]; // of any interleave, of the largest
    gpu_pipeline edges, blur, upsample;
    vec3s axes[VCT_MAX_CONES];
};

struct vct_frame;
struct vct_temporal;

// The cone set of a voxel, around its normal.
struct vct_cone_params vct_voxel_cones(const struct vct_frame *frame);
// Writes irradiance or visibility: with `temporal`, that of the frame alone. NULL: without.
void vct_record_cones(const struct vct_cones *cones, const struct vct_pixels *pixels,
                      const struct vct_temporal *temporal, const struct vct_frame *frame);
