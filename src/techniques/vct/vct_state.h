// The state of voxel cone tracing: that of its stages, and of its views.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/vct/cones/cones.h"
#include "techniques/vct/cones/specular.h"
#include "techniques/vct/cones/temporal.h"
#include "techniques/vct/lighting/lighting.h"
#include "techniques/vct/vct_diagnostics.h"
#include "techniques/vct/vct_frame.h"

struct vct_view {
    struct vct_pixels pixels; // empty if there is no such view
    struct vct_reflections reflections;
    struct vct_temporal temporal; // with temporal
};

struct vct {
    struct vct_options options;
    struct vct_clipmap clipmap;
    struct vct_voxels voxels;
    struct vct_volume volume;
    struct vct_svo svo; // with storage=svo
    struct vct_rays rays;
    struct vct_small_emitters small_emitters;
    struct vct_lighting lighting;
    struct vct_cones cones;
    struct vct_specular specular;
    struct vct_temporal_pipelines history;
    struct vct_overflow overflow;
    gpu_pipeline debug;

    struct vct_view views[FRAME_MAX_VIEWS];
    int begun; // view whose history and points on small emitters are those of the frame

    // Kept between frames.
    struct kept kept;
    struct vct_params params; // of the frame being recorded
    bool ready;               // the grids are placed
    bool settles;             // bounces of a change were left when the frame began
};
