// The exposure value, kept on the GPU: given, or from the log-average of the direct image as image/tonemap.h's
// auto_exposure defines it.
#pragma once

#include "gpu/gpu.h"

struct exposure {
    struct gpu *gpu;
    gpu_pipeline sum, finish;
    gpu_buffer state; // struct exposure_values
    gpu_buffer sums;
    gpu_sampler nearest;
};

bool exposure_init(struct exposure *exposure, struct gpu *gpu);
void exposure_finish(struct exposure *exposure); // accepts zero
void exposure_record_fixed(const struct exposure *exposure, struct gpu_cmd *cmd, float ev);
void exposure_record_auto(const struct exposure *exposure, struct gpu_cmd *cmd,
                          struct gpu_binding constants, gpu_image direct, uint32_t width,
                          uint32_t height);
// Waits; the newest finished frame's.
bool exposure_read(struct exposure *exposure, float *ev);
