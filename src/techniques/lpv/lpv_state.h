// The private state of light propagation volumes, shared by its stages.
#pragma once

#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_math.h"
#include "techniques/lpv/lpv_shared.h"
#include "techniques/technique.h"

struct lpv_options {
#define OPTION OPTION_FIELD
#include "techniques/lpv/lpv_options.def"
#undef OPTION
};

enum lpv_precision { LPV_PRECISION_HALF, LPV_PRECISION_FLOAT };

// Texels of a cell: 12 or 27 coefficients, four to a texel (lpv_light.glsl).
static inline uint32_t lpv_slabs(const struct lpv_options *options)
{
    return options->bands == 3 ? 7 : 3;
}

static inline size_t lpv_cell_bytes(const struct lpv_options *options) // of a cell's 64-bit sums
{
    return 4 * (size_t)lpv_slabs(options) * 8;
}

// Of passes and objects, "technique.thing".
struct lpv_names {
    const char *inject, *inject_emitters, *resolve, *propagate, *apply, *debug;
    const char *sums, *injected, *steps[2], *light, *linear;
};

struct lpv {
    const struct lpv_names *names;
    struct gpu *gpu;
    struct lpv_options options;
    gpu_sampler linear;
    gpu_pipeline inject, inject_emitters, resolve, propagate, apply, debug;
    gpu_buffer sums;    // [cell][coefficient][colour] 64-bit integers
    gpu_image injected; // volumes: dim² × slabs · dim texels
    gpu_image steps[2]; // in turn; with half precision only the first, and `light` is the other
    gpu_image light;    // RGBA16F: accumulated over all steps
    struct lpv_grid grid;
    struct lpv_params params; // of the frame being recorded
    bool lit;                 // the frame being recorded has light and something to light
};

// Places the grid and chooses the scales; false where there is nothing to do.
bool lpv_prepare(struct lpv *lpv, const struct frame_view *view);
// The stages, in order. Each reads lpv->params.
void lpv_record_injection(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd);
void lpv_record_application(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
// Draws the view LPV_VIEW_… into `out` (RGBA16F of the frame's size).
void lpv_record_debug(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t what, gpu_image out);
