// Two methods of voxel cone tracing side by side: alternating frames, time of each stage.
#ifndef AG_BENCH_PAPER_VCT_MEASURE_H
#define AG_BENCH_PAPER_VCT_MEASURE_H

#include "bench.h"

enum { VCT_METHODS = 2, VCT_MAX_STAGES = 12 };

// A stage is a sum of passes. A name that ends with a dot is a prefix.
struct vct_stage {
    const char *name;
    const char *passes[VCT_METHODS][10]; // of each method; NULL-terminated
};

struct vct_method {
    double ms[VCT_MAX_STAGES]; // of each stage, minimum over frames
    double total_ms;           // of all stages together, minimum over frames
    uint64_t bytes;            // GPU memory of the technique
};

struct vct_measurement {
    const struct bench *bench;
    struct ag_scene *scene;
    const struct ag_frame_desc *frame;
    const char *gi[VCT_METHODS];
    const struct vct_stage *stages;
    int stage_count;
};

enum ag_result vct_measure(const struct vct_measurement *measurement,
                           struct vct_method out[VCT_METHODS]);

#endif
