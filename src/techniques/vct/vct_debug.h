// Debug views of the voxels.
#pragma once

#include "frame/frame.h"

struct vct;

// what: VCT_VIEW_…
void vct_record_debug(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t what, gpu_image out);
