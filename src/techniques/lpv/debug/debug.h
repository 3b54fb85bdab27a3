// Debug views.
#pragma once

#include "gpu/gpu.h"

struct lpv_cascade;
struct lpv_frame;

// Draws LPV_VIEW_… into `out` (RGBA16F of the frame's size).
void lpv_record_debug(gpu_pipeline pipeline, const struct lpv_frame *frame,
                      const struct lpv_cascade *finest, uint32_t debug_view, gpu_image out);
