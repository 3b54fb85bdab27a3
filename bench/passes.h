// GPU times of a renderer's passes over several frames; include/afterglow alone.
#pragma once

#include <afterglow/afterglow.h>

enum { PASSES_MAX = 64, PASSES_MAX_FRAMES = 1000 };

struct pass_time {
    char name[48];            // as ag_timing has it
    int count;                // frames that had the pass
    double median_ms, p95_ms; // the middle, and the least value that 95 % do not exceed
};

// Renders 1 + `frames` frames, each waited for, and leaves out the first, which pays for what later
// ones find ready. 1 ≤ frames ≤ PASSES_MAX_FRAMES. *count passes, in the order in which they
// appeared.
enum ag_result passes_measure(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                              int frames, struct pass_time out[PASSES_MAX], int *count);
