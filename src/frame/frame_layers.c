// The images of a frame: formats, creation, destruction.
#include "frame/frame_state.h"

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
    [FRAME_DIRECT_IRRADIANCE] = { "frame.direct_irradiance", GPU_RGBA16F,
                                  GPU_SAMPLED | GPU_STORAGE },
    [FRAME_IRRADIANCE] = { "frame.irradiance", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_SPECULAR] = { "frame.specular", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_VISIBILITY] = { "frame.visibility", GPU_R8, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_INDIRECT] = { "frame.indirect", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
    [FRAME_RADIANCE] = { "frame.radiance", GPU_RGBA16F, GPU_SAMPLED | GPU_STORAGE },
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

uint32_t frame_gbuffer_layers(uint32_t needs, bool has_dielectrics)
{
    return FRAME_LEAST_GBUFFER | 1u << FRAME_MATERIAL | 1u << FRAME_EMISSIVE |
           (needs & FRAME_NEEDS_MOTION ? 1u << FRAME_MOTION : 0) |
           (needs & FRAME_NEEDS_ID ? 1u << FRAME_ID : 0) |
           (has_dielectrics ? 1u << FRAME_DIELECTRIC : 0);
}

uint32_t frame_image_layers(const struct frame_input *input, uint32_t needs)
{
    return 1u << FRAME_DIRECT | 1u << FRAME_COLOR |
           (needs & FRAME_NEEDS_DIRECT_IRRADIANCE ? 1u << FRAME_DIRECT_IRRADIANCE : 0) |
           (needs & FRAME_WRITES_IRRADIANCE ? 1u << FRAME_IRRADIANCE : 0) |
           (needs & FRAME_WRITES_SPECULAR ? 1u << FRAME_SPECULAR : 0) |
           (needs & FRAME_WRITES_VISIBILITY ? 1u << FRAME_VISIBILITY : 0) |
           (needs & FRAME_ANTIALIASES ? 1u << FRAME_RADIANCE : 0) |
           (input->want_indirect_layer ? 1u << FRAME_INDIRECT : 0) |
           (input->want_display ? 1u << FRAME_DISPLAY : 0);
}

uint32_t frame_kept_layers(const struct frame_input *input)
{
    if (input->keep_layers) return ~0u;
    return 1u << FRAME_COLOR | (input->want_display ? 1u << FRAME_DISPLAY : 0) |
           (input->want_indirect_layer ? 1u << FRAME_INDIRECT : 0) |
           (input->want_motion_layer ? 1u << FRAME_MOTION : 0);
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
    frame->gbuffer = gbuffer;
    for (int l = 0; gbuffer && l < FRAME_LAYER_COUNT; l++) {
        const bool converted = gbuffer->encoding && l != FRAME_ID;
        if (converted || !gbuffer->layers[l].id || !frame_layer_is_gbuffer((enum frame_layer)l))
            continue;
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
    frame->gbuffer = NULL;
}

// Whether the image of a further view has the memory that it should have.
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
    antialias_history_finish(&frame->antialias, frame->gpu);
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
