// Debug views of the voxels.
#pragma once

#include "frame/frame.h"

struct vct;

// which: VCT_VIEW_…
void vct_record_debug(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t which, gpu_image out);
