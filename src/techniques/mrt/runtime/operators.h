// Operators as the shaders read them (operators.glsl): rows of four numbers at a time, half floats
// or floats.
#pragma once

#include "techniques/mrt/runtime/runtime.h"

// Rounded up to a multiple of four.
static inline uint32_t mrt_quads(int modes)
{
    return (uint32_t)(modes + 3) / 4;
}
// Tiles of MRT_LOCAL texels of the light map of clutter.
static inline size_t mrt_clutter_map_tiles(size_t texels)
{
    return (texels + MRT_LOCAL - 1) / MRT_LOCAL;
}
// Uploads all operators into new buffers.
bool mrt_operators_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
