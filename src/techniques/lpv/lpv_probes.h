// The probe volume of the grid: a probe in the middle of each cell (frame/probes.glsl), of the
// coarsest where there are cascades. All of it does nothing where the option `probes` is off.
#pragma once

#include "gpu/gpu.h"

struct lpv;
struct lpv_options;
struct probe_volume;

struct lpv_probes {
    gpu_image volume; // RGBA16F, dim² × FRAME_PROBE_SLABS · dim texels
    gpu_pipeline pipeline;
};

bool lpv_probes_create(struct lpv *lpv);
void lpv_probes_destroy(struct lpv *lpv);
uint64_t lpv_probes_bytes(const struct lpv_options *options);
// Of the frame being recorded; one dark probe where there is no light.
void lpv_record_probes(struct lpv *lpv, struct gpu_cmd *cmd);
bool lpv_probes_publish(const struct lpv *lpv, struct probe_volume *out);
