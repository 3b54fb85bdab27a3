// The reflecting surfaces of each cell, for further bounces.
#pragma once

#include "gpu/gpu.h"
#include "techniques/lpv/lpv_history.h"

// Those of a cascade.
struct lpv_surfaces {
    gpu_buffer areas;           // [cell][direction][colour] reflecting area (surfaces.comp)
    struct lpv_statics statics; // of `areas`
    bool at_rest; // `areas` holds moving draws, too; else the sums of injection hold all of a frame
};

struct lpv_surface_pipelines {
    gpu_pipeline opaque, masked;
};

struct lpv_cascade;
struct lpv_frame;

// Changes cascade->surfaces; nothing where the option `bounces` is 0. After the injection, whose
// sums it may overwrite.
void lpv_record_surfaces(const struct lpv_surface_pipelines *pipelines,
                         const struct lpv_frame *frame, struct lpv_cascade *cascade);
// The areas of the frame being recorded.
gpu_buffer lpv_surface_areas(const struct lpv_frame *frame, const struct lpv_cascade *cascade);
