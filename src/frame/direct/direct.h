// Direct light: one compute pass from the G-buffer and the shadow maps to FRAME_DIRECT.
#pragma once

#include "gpu/gpu.h"

struct direct {
    struct gpu *gpu;
    gpu_pipeline lit[2], unlit; // frames with lights, [with FRAME_DIELECTRIC], and without
    gpu_sampler nearest;
};

struct direct_input {
    gpu_image depth, normal, albedo, material, emissive;
    gpu_image dielectric; // may be empty
    gpu_image shadow_maps;
    gpu_sampler shadow_sampler;
    uint32_t shadow_size;
    int shadow_radius; // filter radius, texels
    struct gpu_binding constants, lights, shadow_faces, ggx_albedo;
    int light_count;
    uint32_t width, height;
};

bool direct_init(struct direct *direct, struct gpu *gpu);
void direct_record(const struct direct *direct, struct gpu_cmd *cmd, const struct direct_input *in,
                   gpu_image out);
void direct_finish(struct direct *direct); // accepts zero
