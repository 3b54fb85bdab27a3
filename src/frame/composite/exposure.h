// The exposure value (EV), kept on the GPU: fixed, or by the rule of image/exposure.h from the
// frame's radiance, which the METER variant of the composite pass counts into a histogram.
#pragma once

#include "core/vec.h"
#include "frame/composite/exposure_shared.h"
#include "gpu/gpu.h"

struct exposure {
    struct gpu *gpu;
    gpu_pipeline finish;
    gpu_buffer state;     // struct exposure_values
    gpu_buffer histogram; // struct exposure_counts
};

bool exposure_init(struct exposure *exposure, struct gpu *gpu);
void exposure_finish(struct exposure *exposure); // accepts zero
void exposure_record_fixed(const struct exposure *exposure, struct gpu_cmd *cmd, float ev);
// Automatic: clear the histogram, fill it by composite_record, then find the exposure. A
// fallback of 0: EV 0 if no visible surface is lit. The mean of EVs begins with a share of 1.
void exposure_record_clear(const struct exposure *exposure, struct gpu_cmd *cmd);
void exposure_record_auto(const struct exposure *exposure, struct gpu_cmd *cmd,
                          struct gpu_binding constants, const struct exposure_push *push);
// Value of the newest completed frame. Waits for the GPU.
bool exposure_read(struct exposure *exposure, float *ev);
