// Passes over the pixels of a view that have a surface (columns.glsl).
#pragma once

#include "gpu/gpu.h"

struct frame_view;

struct light_map_columns {
    uint32_t width, height; // of a workgroup, in invocations
    uint32_t rows;          // of pixels, of an invocation
};

struct light_map_columns light_map_columns_for(struct gpu *gpu);
// Irradiance 0, alpha 1, and specular light 0 of all pixels: those without a surface keep it.
void light_map_clear_pixels(struct gpu_cmd *cmd, const struct frame_view *view);
