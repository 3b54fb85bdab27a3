// Specular cones: one per pixel.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cones_shared.h"

struct vct;

void vct_record_specular(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
