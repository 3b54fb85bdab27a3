// The images of a frame: formats, creation, destruction, memory estimate.
#include "frame/frame_state.h"

#include "core/ggx_albedo.h"

struct layer {
    const char *name;
    enum gpu_format format;
    uint32_t usage;
};

static const struct layer table[FRAME_LAYER_COUNT] = {
    [FRAME_DEPTH] = { "frame.depth", GPU_D32F, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_NORMAL] = { "frame.normal", GPU_RG16F, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_ALBEDO] = { "frame.albedo", GPU_RGBA8_SRGB, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_MATERIAL] = { "frame.material", GPU_RG8, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_DIELECTRIC] = { "frame.dielectric", GPU_RGBA8, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_EMISSIVE] = { "frame.emissive", GPU_RGBA16F, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_MOTION] = { "frame.motion", GPU_RGBA16F, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_ID] = { "frame.id", GPU_RG32U, GPU_SAMPLED | GPU_ATTACHMENT },
    [FRAME_DIRECT] = { "frame.direct", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_IRRADIANCE] = { "frame.irradiance", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_SPECULAR] = { "frame.specular", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_VISIBILITY] = { "frame.visibility", GPU_R8, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_INDIRECT] = { "frame.indirect", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_COLOR] = { "frame.color", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_DISPLAY] = { "frame.display", GPU_RGBA8, GPU_SAMPLED | GPU_STORAGE },
};

// Views are recorded one after the other, and each writes a layer before it reads it.
static bool is_aliased(const struct frame *frame, int l)
{
    return frame->view_number == 0 || !(frame->own >> l & 1u);
}

static uint32_t with_bit(uint32_t bits, int l, bool set)
{
    return set ? bits | 1u << l : bits & ~(1u << l);
}

static bool make_layer(struct frame *frame, int l)
{
    if (frame->layers[l].id) return true;
    frame->aliased = with_bit(frame->aliased, l, is_aliased(frame, l));
    frame->neutral = with_bit(frame->neutral, l, false);
    struct gpu_image_desc desc = {
        .name = table[l].name,
        .dimension = GPU_2D,
        .format = table[l].format,
        .width = frame->width,
        .height = frame->height,
        .usage = table[l].usage,
        .alias = is_aliased(frame, l) ? table[l].name : NULL,
    };
    return gpu_image_create(frame->gpu, &desc, &frame->layers[l]);
}

enum gpu_format frame_layer_format(enum frame_layer layer)
{
    return table[layer].format;
}

bool frame_layer_is_gbuffer(enum frame_layer layer)
{
    return layer >= FRAME_DEPTH && layer <= FRAME_ID;
}

void frame_import_gbuffer(struct frame *frame, const struct frame_gbuffer *gbuffer)
{
    frame_forget_gbuffer(frame);
    for (int l = 0; gbuffer && l < FRAME_LAYER_COUNT; l++) {
        if (!gbuffer->layers[l].id || !frame_layer_is_gbuffer((enum frame_layer)l)) continue;
        gpu_image_destroy(frame->gpu, &frame->layers[l]);
        frame->layers[l] = gbuffer->layers[l];
        frame->imported |= 1u << l;
    }
}

void frame_forget_gbuffer(struct frame *frame)
{
    for (int l = 0; l < FRAME_LAYER_COUNT; l++)
        if (frame->imported >> l & 1u) frame->layers[l] = (gpu_image){ 0 };
    frame->imported = 0;
}

// Of a further view: its image has the memory that it should have.
static bool is_settled(const struct frame *frame, int l)
{
    return frame->view_number == 0 || frame->imported >> l & 1u ||
           (frame->aliased >> l & 1u) == is_aliased(frame, l);
}

bool frame_make_layers(struct frame *frame, uint32_t written, uint32_t kept)
{
    frame->unwritten = kept & ~written;
    for (int l = 0; l < FRAME_LAYER_COUNT; l++) {
        const bool wanted = (written | kept) >> l & 1u;
        if (!wanted || !is_settled(frame, l)) gpu_image_destroy(frame->gpu, &frame->layers[l]);
        if (wanted && !make_layer(frame, l)) return false;
    }
    return true;
}

bool frame_pin_layer(struct frame *frame, enum frame_layer layer)
{
    if ((unsigned)layer >= FRAME_LAYER_COUNT) return false;
    frame->pinned |= 1u << layer;
    frame->own |= 1u << layer;
    if (!is_settled(frame, (int)layer)) gpu_image_destroy(frame->gpu, &frame->layers[layer]);
    return frame->width == 0 || make_layer(frame, (int)layer);
}

void frame_clear_unwritten(struct frame *frame, struct gpu_cmd *cmd)
{
    if (frame->common->viewed) frame->neutral &= ~frame->aliased; // overwritten
    for (int l = 0; l < FRAME_LAYER_COUNT; l++) {
        const float value = l == FRAME_VISIBILITY || l == FRAME_MATERIAL ? 1.0f : 0.0f;
        const float other = l == FRAME_MATERIAL ? 0.0f : value; // roughness 1, metallic 0
        if (frame->unwritten & ~frame->neutral & 1u << l)
            gpu_clear_image(cmd, frame->layers[l], (const float[4]){ value, other, other, other });
    }
    frame->neutral = frame->unwritten;
}

void frame_destroy_layers(struct frame *frame)
{
    frame->neutral = frame->kept = 0;
    frame_forget_gbuffer(frame);
    for (int l = 0; l < FRAME_LAYER_COUNT; l++) gpu_image_destroy(frame->gpu, &frame->layers[l]);
}

bool frame_keeps_layer(const struct frame *frame, enum frame_layer layer)
{
    return (unsigned)layer < FRAME_LAYER_COUNT && frame->kept >> layer & 1u;
}

gpu_image frame_layer_image(const struct frame *frame, enum frame_layer layer)
{
    if ((unsigned)layer >= FRAME_LAYER_COUNT) return (gpu_image){ 0 };
    return frame->layers[layer];
}

// Upper bound: all layers, and every light a sun or a point light, whichever has more texels.
uint64_t frame_memory_estimate(const struct frame_options *options, uint32_t width, uint32_t height,
                               int light_count)
{
    uint64_t texel_bytes = 0;
    for (int l = 0; l < FRAME_LAYER_COUNT; l++)
        texel_bytes += (uint64_t)gpu_format_bytes(table[l].format);
    uint64_t lights = (uint64_t)(light_count > 0 ? light_count : 0);
    uint64_t shadow = (uint64_t)options->shadow_size, rsm = (uint64_t)options->rsm_size;
    uint64_t sun = (uint64_t)options->cascades * shadow * shadow,
             local = 6 * (shadow / 2) * (shadow / 2);
    int rsm_bytes = gpu_format_bytes(GPU_D32F) + gpu_format_bytes(GPU_RG16F) +
                    gpu_format_bytes(GPU_RGBA8_SRGB); // per texel
    return sizeof ggx_albedo_table + texel_bytes * width * height +
           lights * ((sun > local ? sun : local) * (uint64_t)gpu_format_bytes(GPU_D32F) +
                     6 * rsm * rsm * (uint64_t)rsm_bytes);
}
