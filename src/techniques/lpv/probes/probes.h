// The probe volume, a probe in the centre of each cell of the finest cascade that covers the scene.
#pragma once

#include "frame/frame.h"

struct lpv_probe_volume {
    gpu_pipeline pipeline;
    gpu_image image;          // RGBA16F: irradiance probes
    struct frame_probes grid; // of the frame being recorded
};

struct lpv_cascade;
struct lpv_frame;
struct lpv_options;
struct probe_volume;

// One black probe.
void lpv_probes_create(struct lpv_probe_volume *probes, const struct lpv_options *options);
// Both do nothing where the option `probes` is off. finest: NULL without light, one black probe.
void lpv_record_probes(struct lpv_probe_volume *probes, const struct lpv_frame *frame,
                       const struct lpv_cascade *finest);
bool lpv_probes_publish(const struct lpv_probe_volume *probes, const struct lpv_options *options,
                        struct probe_volume *out);
