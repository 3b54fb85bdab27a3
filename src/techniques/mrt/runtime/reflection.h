// One bounce within the reduced spaces: b of the light that a block reflects of b and of r.
#pragma once

#include "techniques/mrt/runtime/runtime.h"

// Scales of b-coefficients on the GPU.
struct mrt_scales {
    float *of_b;    // [basis][k_b]: the stored b over the dictionary's
    float *inverse; // [basis][k_b]
    int k_b;
};

// Computes and uploads the operators of all blocks.
bool mrt_reflection_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                           const struct mrt_scales *scales);
