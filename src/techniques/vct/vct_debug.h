// Debug views of the voxels.
#pragma once

#include "gpu/gpu.h"

struct vct_frame;

// which: VCT_VIEW_…
void vct_record_debug(gpu_pipeline pipeline, const struct vct_frame *frame, uint32_t which,
                      gpu_image out);
