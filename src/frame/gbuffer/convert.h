// Converts a caller's G-buffer into the frame's own.
#pragma once

#include "frame/gbuffer/gbuffer.h"
#include "frame/gbuffer/gbuffer_encoding.h"

struct gbuffer_convert {
    struct gpu *gpu;
    gpu_pipeline pipelines[GBUFFER_LAYER_SETS]; // [gbuffer_layers], without GBUFFER_ID
};

// The caller's images; those but depth, normal and albedo may be empty.
struct gbuffer_sources {
    gpu_image depth, normal, albedo, material, emissive, motion, dielectric;
};

bool gbuffer_convert_prepare(struct gbuffer_convert *convert, struct gpu *gpu, uint32_t layers);
// The targets have no id. The encoding says nothing yet of absent images.
void gbuffer_convert_record(const struct gbuffer_convert *convert, struct gpu_cmd *cmd,
                            const struct gbuffer_sources *sources,
                            const struct gbuffer_encoding *encoding,
                            const struct gbuffer_targets *targets, struct gpu_binding constants);
void gbuffer_convert_finish(struct gbuffer_convert *convert); // accepts zero
