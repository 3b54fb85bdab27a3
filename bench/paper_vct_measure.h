// Methods of voxel cone tracing side by side: frames in turns, and the time of their stages;
// include/afterglow alone.
#pragma once

#include <afterglow/afterglow.h>

enum { VCT_METHODS = 2, VCT_MOST_STAGES = 12 };

// A stage is the sum of passes. A name that ends with a dot stands for all passes that begin so.
struct vct_stage {
    const char *name;
    const char *passes[VCT_METHODS][8]; // of each method; ends with NULL
};

struct vct_method {
    double ms[VCT_MOST_STAGES]; // of each stage, the least of all frames
    double all_ms;              // of all these stages together, the least
    uint64_t bytes;             // of GPU memory that the technique takes
};

struct vct_measurement {
    struct ag_device *device;
    struct ag_scene *scene;
    const struct ag_frame_desc *frame;
    int width, height, frames;
    const char *gi[VCT_METHODS];
    const struct vct_stage *stages;
    int stage_count;
};

// Renders 1 + `frames` frames of each method in turns, each waited for; the first is left out.
enum ag_result vct_measure(const struct vct_measurement *how, struct vct_method out[VCT_METHODS]);
