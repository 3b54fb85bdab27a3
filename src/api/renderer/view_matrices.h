// A caller's camera by matrices.
#pragma once

#include "api/objects.h"

#include "frame/frame.h"

// camera: with reversed depth, and without a far plane in a perspective. What the program's own
// depth has is beside it.
struct api_view {
    struct frame_camera camera;
    float host_far_m;   // INFINITY: none
    bool forward_depth; // 0 at the near plane, 1 at the far plane
};
enum ag_result api_view_of_matrices(struct ag_context *context, const char *function,
                                    const struct ag_view_matrices *matrices, struct api_view *out);
