// The exposure value (EV), kept on the GPU: fixed, or the log-average that auto_exposure in
// image/tonemap.h defines. Metering does not depend on the technique, so that images of one scene
// have the same exposure with each of them.
#pragma once

#include "core/vec.h"
#include "gpu/gpu.h"

struct exposure {
    struct gpu *gpu;
    gpu_pipeline sum[2], finish; // sum: of each pass over the image
    gpu_buffer state;            // struct exposure_values
    gpu_buffer sums;
    gpu_sampler nearest;
};

bool exposure_init(struct exposure *exposure, struct gpu *gpu);
void exposure_finish(struct exposure *exposure); // accepts zero
void exposure_record_fixed(const struct exposure *exposure, struct gpu_cmd *cmd, float ev);
// Metered at each surface: the direct layer plus the diffuse reflection of the irradiance
// `emitted`.
struct exposure_input {
    gpu_image direct, albedo, material;
    gpu_image scratch; // RGBA16F of the same size, overwritten
    vec3s emitted;     // scaled lux
    float fallback;    // scaled luminance if no visible surface is lit; 0: EV 0
    uint32_t width, height;
};
void exposure_record_auto(const struct exposure *exposure, struct gpu_cmd *cmd,
                          struct gpu_binding constants, const struct exposure_input *input);
// Value of the newest completed frame. Waits for the GPU.
bool exposure_read(struct exposure *exposure, float *ev);
