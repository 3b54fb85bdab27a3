// Diffuse cones of the pixels: tracing, gathering from neighbours, upsampling.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cone_sets.h"
#include "techniques/vct/cones/cones_shared.h"

struct vct;

// The cone set of a voxel, around its normal.
struct vct_cone_params vct_voxel_cones(const struct vct *vct, const struct frame_view *view);
// Writes irradiance or visibility.
void vct_record_cones(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
