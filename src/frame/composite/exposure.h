// The exposure value, kept on the GPU: given, or from a log-average as image/tonemap.h's
// auto_exposure defines it. What is metered is the same for every technique, so that pictures of
// one scene by several of them can be compared.
#pragma once

#include "core/vec.h"
#include "gpu/gpu.h"

struct exposure {
    struct gpu *gpu;
    gpu_pipeline sum[2], finish; // of each round
    gpu_buffer state;            // struct exposure_values
    gpu_buffer sums;
    gpu_sampler nearest;
};

bool exposure_init(struct exposure *exposure, struct gpu *gpu);
void exposure_finish(struct exposure *exposure); // accepts zero
void exposure_record_fixed(const struct exposure *exposure, struct gpu_cmd *cmd, float ev);
// What is metered where there is a surface: the direct image, and what the surface would reflect of
// the irradiance `emitted` (scaled lux); where nothing of it is lit, `fallback` (scaled luminance,
// 0: EV 0).
struct exposure_input {
    gpu_image direct, albedo, material;
    gpu_image scratch; // RGBA16F, as large; what is in it is lost
    vec3s emitted;
    float fallback;
    uint32_t width, height;
};
void exposure_record_auto(const struct exposure *exposure, struct gpu_cmd *cmd,
                          struct gpu_binding constants, const struct exposure_input *input);
// Waits; the newest finished frame's.
bool exposure_read(struct exposure *exposure, float *ev);
