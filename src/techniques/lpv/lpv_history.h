// Which results of earlier frames are kept.
#pragma once

#include "techniques/lpv/lpv_grid.h"

#include <stdbool.h>

struct frame_view;
struct lpv_cascade;
struct lpv_options;
struct scene_draw;

// Static draws have not moved since the scene was set.
bool lpv_is_static(const struct scene_draw *draw);
bool lpv_is_moving(const struct scene_draw *draw);

// Whether the light of a cascade is that of the frame before, unless that of the coarser cascades
// has changed. The parameters and the grid of the frame are complete. Changes cascade->kept.
bool lpv_is_kept(struct lpv_cascade *cascade, const struct lpv_options *options,
                 const struct frame_view *view);

// Key of the cached result of static draws. Zero: nothing is cached.
struct lpv_statics {
    bool valid;
    struct lpv_grid grid;
    bool first_frame; // of the scene
    int moving_count; // moving draws of the scene
    uint64_t set;     // scene_gpu.static_set
};

struct lpv_statics lpv_statics_of(const struct lpv_grid *grid, const struct frame_view *view);
bool lpv_statics_equal(const struct lpv_statics *cached, const struct lpv_statics *now);
