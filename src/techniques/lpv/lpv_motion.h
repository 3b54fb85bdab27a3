// Which results of earlier frames a scene with moving objects keeps.
#pragma once

#include "techniques/lpv/lpv_grid.h"

#include <stdbool.h>

struct frame_view;
struct scene_draw;

// Static draws have not moved since the scene was set.
bool lpv_is_static(const struct scene_draw *draw);
bool lpv_is_moving(const struct scene_draw *draw);

// The inputs of a cached result. Zero: nothing is cached.
struct lpv_motion {
    bool valid;
    struct lpv_grid grid;
    int moving_count; // moving draws of the scene
    uint64_t index;   // of the frame
};

struct lpv_motion lpv_motion_of(const struct lpv_grid *grid, const struct frame_view *view);
// Whether static draws have the same result as in the cached frame.
bool lpv_motion_same_static(const struct lpv_motion *cached, const struct lpv_motion *now);
// Whether moving draws are where they were in the cached frame.
bool lpv_motion_at_rest(const struct lpv_motion *cached, const struct lpv_motion *now,
                        const struct frame_view *view);
