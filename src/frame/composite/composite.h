// Composite pass: direct plus indirect light, and the tone-mapped display image.
#pragma once

#include "gpu/gpu.h"

#include "frame/composite/composite_shared.h"

// Inputs and outputs besides the direct layer: a bit for each COMPOSITE_CONSTANT_….
enum composite_variant {
    COMPOSITE_IRRADIANCE = 1 << COMPOSITE_CONSTANT_IRRADIANCE,
    COMPOSITE_SPECULAR = 1 << COMPOSITE_CONSTANT_SPECULAR,
    COMPOSITE_VISIBILITY = 1 << COMPOSITE_CONSTANT_VISIBILITY,
    COMPOSITE_INDIRECT = 1 << COMPOSITE_CONSTANT_INDIRECT,
    COMPOSITE_DISPLAY = 1 << COMPOSITE_CONSTANT_DISPLAY,
    COMPOSITE_METER = 1 << COMPOSITE_CONSTANT_METER,
    COMPOSITE_AGX = 1 << COMPOSITE_CONSTANT_AGX,
    COMPOSITE_LINEAR = 1 << COMPOSITE_CONSTANT_LINEAR,
    COMPOSITE_VARIANT_COUNT = 1 << COMPOSITE_CONSTANT_COUNT,
};

struct composite {
    struct gpu *gpu;
    gpu_pipeline pipelines[COMPOSITE_VARIANT_COUNT];
    gpu_sampler nearest;
    gpu_image no_radiance, no_display; // 1×1 placeholders for outputs of other variants
};

// An image that the variant does not use may be empty.
struct composite_images {
    gpu_image direct, albedo, irradiance, specular, visibility;
    gpu_image color, indirect, display;
};

bool composite_init(struct composite *composite, struct gpu *gpu);
void composite_finish(struct composite *composite); // accepts zero
bool composite_prepare(struct composite *composite, uint32_t variant);
// bindings: "frame_constants", "exposure_state", "exposure_histogram". With COMPOSITE_METER no
// image is written, the histogram is filled.
void composite_record(const struct composite *composite, struct gpu_cmd *cmd, uint32_t variant,
                      const struct composite_images *images, const struct gpu_binding bindings[3],
                      uint32_t width, uint32_t height);
