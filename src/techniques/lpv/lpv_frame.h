// The inputs of the stages of a frame. A stage has a struct of its own, which it alone changes, and
// reads the others' here and in the cascade.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/lpv/geometry/geometry.h"
#include "techniques/lpv/inject/inject.h"
#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_options.h"
#include "techniques/lpv/surfaces/surfaces.h"

// One grid, or one of several cascades.
struct lpv_cascade {
    struct lpv_grid grid;
    struct lpv_params params; // of the frame being recorded
    int32_t steps;            // of propagation
    struct kept kept;
    struct lpv_geometry geometry;
    struct lpv_surfaces surfaces;
    gpu_image light;             // RGBA16F: accumulated over all steps, see lpv_light.glsl
    struct lpv_cascade *coarser; // the next one; NULL: this is the coarsest
};

struct lpv_frame {
    const struct lpv_options *options;
    struct gpu *gpu;
    struct gpu_cmd *cmd;
    const struct frame_view *view;
    const struct lpv_injection *injection; // its light is that of the cascade being recorded
    gpu_sampler linear;
};

// Any buffer where there are no walls.
static inline gpu_buffer lpv_walls(const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    return frame->options->geometry == LPV_GEOMETRY_SCENE ? cascade->geometry.walls
                                                          : frame->injection->sums;
}
