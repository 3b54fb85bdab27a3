// Display pass: another layer than the frame's colour as the display image, after the composite
// pass.
#pragma once

#include "gpu/gpu.h"

#include "frame/composite/display_shared.h"

// A bit for each DISPLAY_CONSTANT_….
enum display_variant {
    DISPLAY_AGX = 1 << DISPLAY_CONSTANT_AGX,
    DISPLAY_LINEAR = 1 << DISPLAY_CONSTANT_LINEAR,
    DISPLAY_VARIANT_COUNT = 1 << DISPLAY_CONSTANT_COUNT,
};

struct display {
    struct gpu *gpu;
    gpu_pipeline pipelines[DISPLAY_VARIANT_COUNT];
};

struct display_images {
    gpu_image shown, albedo, display;
};

bool display_prepare(struct display *display, struct gpu *gpu, uint32_t variant);
void display_finish(struct display *display); // accepts zero
// kind: DISPLAY_…; bindings: "frame_constants", "exposure_state".
void display_record(const struct display *display, struct gpu_cmd *cmd, uint32_t variant,
                    uint32_t kind, const struct display_images *images,
                    const struct gpu_binding bindings[2], uint32_t width, uint32_t height);
