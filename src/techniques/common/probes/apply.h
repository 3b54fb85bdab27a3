// Pixels lit by a probe volume with depths: those that a light map has not lit.
#pragma once

#include "techniques/common/probes/volume.h"

struct frame_view;

struct probe_apply {
    gpu_pipeline pipeline;
    gpu_sampler linear;
};

// How pixels get specular light.
enum probe_specular {
    PROBE_APPLY_DIFFUSE,  // none
    PROBE_APPLY_SPECULAR, // irradiance over π in the mean direction of the lobe
    PROBE_APPLY_RADIANCE, // the mean of the volume's radiance over the lobe
};

// Adds its objects at this offset of the state.
void probe_apply_list(size_t base, enum probe_specular specular, struct gpu_objects *out);
// has_map: pixels that a light map has lit are left out. The volume has radiance if the pass needs
// it.
void probe_apply_record(const struct probe_apply *apply, const struct probe_volume *volume,
                        struct gpu_cmd *cmd, const struct frame_view *view, bool has_map);
