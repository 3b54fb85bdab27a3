// Volume probes of a level on the GPU (Loos 2015, section 3.5.5).
#pragma once

#include "techniques/mrt/runtime/runtime.h"

bool mrt_probes_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// One dark point to publish.
bool mrt_probes_make_empty(struct mrt_runtime *runtime);
// MRT_CONSTANT_SIGHT.
uint32_t mrt_sight_voxels(const struct mrt_operators *operators);
