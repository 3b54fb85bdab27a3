// The G-buffer pass: rasterises the scene from the camera into FRAME_DEPTH … FRAME_MOTION.
#pragma once

#include "frame/scene/scene_gpu.h"

// The optional layers.
enum gbuffer_layers {
    GBUFFER_MOTION = 1,
    GBUFFER_DIELECTRIC = 2,
    GBUFFER_ID = 4,
    GBUFFER_LAYER_SETS = 8,
};

struct gbuffer {
    struct gpu *gpu;
    gpu_pipeline pipelines[GBUFFER_LAYER_SETS][VARIANT_COUNT]; // [gbuffer_layers]
};

struct gbuffer_targets {
    gpu_image depth, normal, albedo, material, emissive;
    gpu_image motion, dielectric, id; // may be empty
    uint32_t width, height;
};

// Formats, depth test and rendering of all passes that write a G-buffer.
struct gpu_graphics_desc gbuffer_pipeline_desc(uint32_t layers);
uint32_t gbuffer_layers_of(const struct gbuffer_targets *targets);
void gbuffer_begin(struct gpu_cmd *cmd, const struct gbuffer_targets *targets,
                   const struct gpu_binding *reads, int read_count);

// Creates missing pipelines for these variants (bit v: variant v).
bool gbuffer_prepare(struct gbuffer *gbuffer, struct gpu *gpu, uint32_t variants, uint32_t layers);
void gbuffer_record(const struct gbuffer *gbuffer, struct gpu_cmd *cmd,
                    const struct scene_gpu *scene, const struct gbuffer_targets *targets,
                    mat4s clip_from_world, struct gpu_binding constants);
void gbuffer_finish(struct gbuffer *gbuffer); // accepts zero
