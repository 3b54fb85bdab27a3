// The G-buffer: what the camera sees, as the layers FRAME_DEPTH … FRAME_MOTION.
#pragma once

#include "frame/scene_gpu.h"

struct gbuffer {
    struct gpu *gpu;
    gpu_pipeline pipelines[2][VARIANT_COUNT]; // [with motion]
};

struct gbuffer_targets {
    gpu_image depth, normal, albedo, material, emissive;
    gpu_image motion; // none: not wanted
    uint32_t width, height;
};

// Makes the pipelines for these variants (bit v: variant v) that are not there yet.
bool gbuffer_prepare(struct gbuffer *gbuffer, struct gpu *gpu, uint32_t variants, bool motion);
void gbuffer_record(const struct gbuffer *gbuffer, struct gpu_cmd *cmd,
                    const struct scene_gpu *scene, const struct gbuffer_targets *targets,
                    mat4s clip_from_world, struct gpu_binding constants);
void gbuffer_finish(struct gbuffer *gbuffer); // accepts zero
