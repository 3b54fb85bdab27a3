// Pixels lit by a probe volume with depths: those that a light map has not lit.
#pragma once

#include "techniques/common/probes/volume.h"

struct frame_view;

struct probe_apply {
    gpu_pipeline pipeline;
    gpu_sampler linear;
};

// Adds its objects at this offset of the state.
void probe_apply_list(size_t base, bool specular, struct gpu_objects *out);
// mapped false: all pixels.
void probe_apply_record(const struct probe_apply *apply, const struct probe_volume *volume,
                        struct gpu_cmd *cmd, const struct frame_view *view, bool mapped);
