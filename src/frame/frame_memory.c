// Estimates of the memory of a frame and of its views: bytes of buffers and texels, without what a
// driver pads.
#include "frame/frame_state.h"

#include "core/ggx_albedo.h"

#include "frame/composite/exposure_shared.h"
#include "frame/shadow/shadow_shared.h"

static const uint64_t GGX_ALBEDO_BYTES =
    sizeof(struct ggx_albedo_texel) * GGX_ALBEDO_SIZE * GGX_ALBEDO_SIZE;

static const uint64_t EXPOSURE_BYTES =
    sizeof(struct exposure_values) + sizeof(struct exposure_counts);

static uint64_t layer_bytes(uint32_t layers, uint32_t width, uint32_t height)
{
    uint64_t bytes = 0;
    for (int l = 0; l < FRAME_LAYER_COUNT; l++)
        if (layers >> l & 1u)
            bytes += (uint64_t)width * height *
                     (uint64_t)gpu_format_bytes(frame_layer_format((enum frame_layer)l));
    return bytes;
}

// As if the scene has dielectrics of an own specular.
static uint32_t layers_of(const struct frame_input *input, uint32_t needs)
{
    if (input->want_motion_layer) needs |= FRAME_NEEDS_MOTION;
    if (input->want_id_layer || input->pick) needs |= FRAME_NEEDS_ID;
    const uint32_t own = input->gbuffer ? 1u << FRAME_MATERIAL : frame_gbuffer_layers(needs, true);
    return own | frame_image_layers(input, needs);
}

// A sun, a point or a spot light: whichever has more texels.
static uint64_t light_bytes(const struct frame_options *options, uint32_t needs)
{
    const uint64_t size = (uint64_t)options->shadow_size, rsm_size = (uint64_t)options->rsm_size;
    const uint64_t blocks = gpu_groups((uint32_t)size, SHADOW_BLOCK);
    const uint64_t sun =
        (uint64_t)options->cascades * (size * size * (uint64_t)gpu_format_bytes(GPU_D32F) +
                                       blocks * blocks * (uint64_t)gpu_format_bytes(GPU_RGBA16F));
    const uint64_t local = 6 * (size / 2) * (size / 2) * (uint64_t)gpu_format_bytes(GPU_D32F);
    const int texel =
        gpu_format_bytes(GPU_D32F) + gpu_format_bytes(GPU_RG16F) + gpu_format_bytes(GPU_RGBA8_SRGB);
    const uint64_t rsm = needs & FRAME_NEEDS_RSM ? 6 * rsm_size * rsm_size * (uint64_t)texel : 0;
    return (sun > local ? sun : local) + rsm;
}

static uint64_t history_bytes(uint32_t needs, uint32_t width, uint32_t height)
{
    return needs & FRAME_ANTIALIASES ? antialias_history_bytes(width, height) : 0;
}

uint64_t frame_memory_estimate(const struct frame_options *options, const struct frame_input *input,
                               uint32_t needs, uint32_t width, uint32_t height)
{
    const uint64_t lights = input->light_count > 0 ? (uint64_t)input->light_count : 0;
    // The list of the pixels that direct light of a single sun leaves undecided.
    const uint64_t list = lights == 1 ? (uint64_t)width * height * sizeof(uint32_t) : 0;
    needs |= frame_antialias_needs(options);
    return EXPOSURE_BYTES + GGX_ALBEDO_BYTES + list +
           layer_bytes(layers_of(input, needs), width, height) +
           history_bytes(needs, width, height) + lights * light_bytes(options, needs);
}

uint64_t frame_view_memory_estimate(const struct frame_options *options,
                                    const struct frame_input *input,
                                    const struct frame_input *first, uint32_t needs, uint32_t width,
                                    uint32_t height, uint64_t more_pixels)
{
    needs |= frame_antialias_needs(options);
    const uint32_t shared = first ? layers_of(first, needs) & ~frame_kept_layers(input) : 0;
    return EXPOSURE_BYTES + more_pixels * sizeof(uint32_t) + history_bytes(needs, width, height) +
           layer_bytes(layers_of(input, needs) & ~shared, width, height);
}
