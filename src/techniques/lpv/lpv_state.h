// The state of light propagation volumes: that of their stages, and of their cascades.
#pragma once

#include "techniques/lpv/apply/apply.h"
#include "techniques/lpv/lpv_frame.h"
#include "techniques/lpv/probes/probes.h"
#include "techniques/lpv/propagate/propagate.h"

struct lpv {
    struct lpv_options options;
    struct gpu *gpu;
    gpu_sampler linear;
    // Shared by all cascades, which are recorded one after the other.
    struct lpv_injection injection;
    struct lpv_geometry_pipelines geometry;
    struct lpv_surface_pipelines surfaces;
    struct lpv_propagation propagation;
    struct lpv_application application;
    struct lpv_probe_volume probes;
    gpu_pipeline debug;

    struct lpv_cascade cascades[LPV_MAX_CASCADES]; // from the finest
    bool lit; // the frame being recorded has light and a scene with extent
};
