// The path-traced reference as a bake: tasks trace the samples of parts of the image, on any number
// of threads and machines.
#pragma once

#include "bake/bake.h"
#include "trace/trace.h"

struct reference_bake {
    const struct scene_pose *pose; // outlives the bake
    struct world_camera camera;
    int width, height; // pixels
    int samples;       // of a pixel, at least 1
    struct reference_options options;
};

// In the identity of the bake. The version grows when samples change for the same inputs.
#define REFERENCE_BAKE_NAME "reference"
enum { REFERENCE_BAKE_VERSION = 1 };
// All but the scene and the seed, as text for the identity; the caller frees it. NULL: no memory.
char *reference_bake_options(struct host *host, const struct reference_bake *how);
bool reference_add_stages(struct bake_plan *plan, const struct reference_bake *how);
// The reference with the samples of a complete bake. NULL on failure.
struct reference *reference_of_bake(struct host *host, const struct reference_bake *how,
                                    const struct tensors *tensors);
