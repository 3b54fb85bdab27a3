// Direct light: one compute pass from the G-buffer and the shadow maps to FRAME_DIRECT, and to
// FRAME_DIRECT_IRRADIANCE if a technique needs it.
#pragma once

#include "frame/direct/direct_shared.h"
#include "gpu/gpu.h"

enum direct_feature {
    DIRECT_DIELECTRIC = 1 << DIRECT_CONSTANT_DIELECTRIC,
    DIRECT_FILTERED = 1 << DIRECT_CONSTANT_FILTERED,
    DIRECT_EMISSION = 1 << DIRECT_CONSTANT_EMISSION,
    DIRECT_MAP = 1 << DIRECT_CONSTANT_MAP,
    DIRECT_IRRADIANCE = 1 << DIRECT_CONSTANT_BITS, // of other shaders, not a constant
    DIRECT_VARIANTS = 2 << DIRECT_CONSTANT_BITS,
};

struct direct {
    struct gpu *gpu;
    gpu_pipeline pipelines[DIRECT_VARIANTS]; // bits DIRECT_CONSTANT_…, and DIRECT_IRRADIANCE
    uint32_t cascades;                       // per sun
    gpu_pipeline undecided[2][2];            // [with irradiance][with emission]
    gpu_buffer list;                         // struct direct_list_header, pixels
    gpu_sampler nearest;
};

struct direct_input {
    gpu_image depth, normal, albedo, material, emissive;
    gpu_image dielectric; // may be empty
    gpu_image shadow_maps, shadow_sun_maps, shadow_blocks;
    gpu_sampler shadow_sampler;
    int shadow_radius; // filter radius, texels
    // lights: FRAME_MAX_LIGHTS. shadow_sun: shadow_sun_view of the only sun.
    struct gpu_binding constants, lights, shadow_faces, shadow_sun, ggx_albedo, environment_map;
    uint32_t variant; // of direct_variant
    uint32_t width, height;
};

bool direct_init(struct direct *direct, struct gpu *gpu, uint32_t cascades);
// The pipeline for a number of suns and of other lights. features: of direct_feature.
uint32_t direct_variant(int suns, int locals, uint32_t features);
// The variant of one sun whose maps have blocks, if there is one; else 0.
uint32_t direct_variant_of_blocks(uint32_t variant);
// Creates what is missing for the variant, and for its variant of blocks, in images of up to so
// many pixels.
bool direct_prepare(struct direct *direct, uint32_t variant, size_t pixels);
// The pipelines alone, for a compiler.
bool direct_compile(struct gpu *compiler, uint32_t variant, uint32_t cascades);
// irradiance: with DIRECT_IRRADIANCE, else empty.
void direct_record(const struct direct *direct, struct gpu_cmd *cmd, const struct direct_input *in,
                   gpu_image out, gpu_image irradiance);
void direct_finish(struct direct *direct); // accepts zero
