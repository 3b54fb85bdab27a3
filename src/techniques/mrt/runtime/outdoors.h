// The grid of outdoor probes on the GPU (level/outdoors.h).
#pragma once

#include "techniques/mrt/runtime/runtime.h"

bool mrt_outdoors_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
