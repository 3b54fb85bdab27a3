// The exposure value (EV), kept on the GPU: fixed, or by the rule of image/exposure.h from the
// frame's radiance, which the METER variant of the composite pass counts into a histogram.
#pragma once

#include "core/vec.h"
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
// Automatic: clear the histogram, fill it by composite_record, then find the exposure. `fallback`
// is the scaled luminance metered if no visible surface is lit; 0: EV 0. share: of this frame in
// the mean of EVs since the one with share 1.
void exposure_record_clear(const struct exposure *exposure, struct gpu_cmd *cmd);
void exposure_record_auto(const struct exposure *exposure, struct gpu_cmd *cmd,
                          struct gpu_binding constants, float fallback, float share);
// Value of the newest completed frame. Waits for the GPU.
bool exposure_read(struct exposure *exposure, float *ev);
