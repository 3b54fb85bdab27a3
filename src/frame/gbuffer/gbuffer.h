// The G-buffer pass: rasterises the scene from the camera into FRAME_DEPTH … FRAME_MOTION.
#pragma once

#include "frame/scene_gpu.h"

struct gbuffer {
    struct gpu *gpu;
    gpu_pipeline pipelines[2][VARIANT_COUNT]; // [with motion]
};

struct gbuffer_targets {
    gpu_image depth, normal, albedo, material, emissive;
    gpu_image motion; // optional
    uint32_t width, height;
};

// Creates missing pipelines for these variants (bit v: variant v).
bool gbuffer_prepare(struct gbuffer *gbuffer, struct gpu *gpu, uint32_t variants, bool motion);
void gbuffer_record(const struct gbuffer *gbuffer, struct gpu_cmd *cmd,
                    const struct scene_gpu *scene, const struct gbuffer_targets *targets,
                    mat4s clip_from_world, struct gpu_binding constants);
void gbuffer_finish(struct gbuffer *gbuffer); // accepts zero
