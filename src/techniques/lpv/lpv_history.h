// Which results of earlier frames are kept.
#pragma once

#include "techniques/lpv/lpv_grid.h"

#include <stdbool.h>

struct frame_view;
struct lpv;
struct scene_draw;

// Static draws have not moved since the scene was set.
bool lpv_is_static(const struct scene_draw *draw);
bool lpv_is_moving(const struct scene_draw *draw);

// Whether objects and lights are those of the frame before, and whether the light of a cascade is,
// too, unless that of the coarser cascades has changed. Zero: no frame before.
struct lpv_history {
    bool valid, moved, kept;
    uint64_t index; // of the frame
    uint64_t light; // hash of what the light depends on
};

// Of the frame being recorded, whose parameters and grid are complete.
void lpv_history_update(struct lpv *lpv, const struct frame_view *view);

// What a cached result of the static draws depends on. Zero: nothing is cached.
struct lpv_statics {
    bool valid;
    struct lpv_grid grid;
    bool first_frame; // of the scene
    int moving_count; // moving draws of the scene
    uint64_t set;     // scene_gpu.static_set
};

struct lpv_statics lpv_statics_of(const struct lpv *lpv, const struct frame_view *view);
bool lpv_statics_equal(const struct lpv_statics *cached, const struct lpv_statics *now);
