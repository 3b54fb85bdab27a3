// Ambient visibility against ray-traced references, for occlusion and paper-vo.
#ifndef AG_BENCH_VISIBILITY_H
#define AG_BENCH_VISIBILITY_H

#include "bench.h"

struct visibility_desc {
    const struct ag_camera *camera;
    int spp;           // rays per pixel
    float radius_m;    // of the obscurance
    float decay_per_m; // of the ambient occlusion
};

// Traces obscurance, ambient occlusion and depth; NULL where an image is not needed.
enum ag_result visibility_trace(const struct bench *bench, struct ag_scene *scene,
                                const struct visibility_desc *desc, struct ag_image **obscurance,
                                struct ag_image **ambient_occlusion, struct ag_image **depth);

// Differences from a reference, over all pixels with a surface (depth above 0).
struct visibility_error {
    double mean, rms, bias; // mean: of absolute values
};
struct visibility_error visibility_compare(const struct ag_image *visibility,
                                           const struct ag_image *reference,
                                           const struct ag_image *depth);

#endif
