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

#define LPV_COLOURS 3
#define LPV_CELL_BYTES (LPV_COLOURS * 4 * 2 * 4) // of a cell's 64-bit sums

// Intensity of one grid: an image per colour, a texel per cell, its four coefficients in the grid's unit.
struct lpv_volume {
    gpu_image colour[LPV_COLOURS];
};

struct lpv {
    struct gpu *gpu;
    struct lpv_options options;
    gpu_sampler linear;
    gpu_pipeline inject, inject_emitters, resolve, propagate, finish, apply, debug;
    gpu_buffer sums;             // [cell][colour][coefficient] 64-bit integers
    struct lpv_volume injected;  // RGBA32F
    struct lpv_volume steps[2];  // RGBA32F, in turn
    struct lpv_volume light;     // RGBA16F: accumulated over all steps
    struct lpv_grid grid;
    struct lpv_params params;    // of the frame being recorded
    bool lit;                    // the frame being recorded has light and something to light
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
