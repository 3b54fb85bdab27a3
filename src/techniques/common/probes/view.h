// Debug view of a probe volume: a white diffuse sphere at each probe, or at every n-th one, lit by
// the probe's irradiance, in front of dimmed surfaces that the probes light.
#pragma once

#include "frame/frame.h"

#include "techniques/common/probes/volume.h"

struct probe_view {
    gpu_pipeline pipeline;
    gpu_sampler linear;
};

bool probe_view_create(struct probe_view *view, struct gpu *gpu);
void probe_view_destroy(struct probe_view *view, struct gpu *gpu); // accepts zero
// Draws into `out`, RGBA16F of the frame's size, scaled radiance.
void probe_view_record(const struct probe_view *view, struct gpu_cmd *cmd,
                       const struct frame_view *frame, const struct probe_volume *volume,
                       gpu_image out);
