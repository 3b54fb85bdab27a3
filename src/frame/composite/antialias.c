// Host code of temporal antialiasing.
#include "frame/composite/antialias.h"

#include "frame_shaders.h"

static bool make_placeholder(struct antialias *a)
{
    const struct gpu_image_desc desc = { .name = "frame.no_antialiased_display",
                                         .dimension = GPU_2D,
                                         .format = GPU_RGBA8,
                                         .width = 1,
                                         .height = 1,
                                         .usage = GPU_STORAGE };
    return a->no_display.id || gpu_image_create(a->gpu, &desc, &a->no_display);
}

bool antialias_prepare(struct antialias *a, struct gpu *gpu, uint32_t variant)
{
    struct gpu_constant constants[ANTIALIAS_CONSTANT_COUNT];
    a->gpu = gpu;
    gpu_constants_of_bits(variant, constants, ANTIALIAS_CONSTANT_COUNT);
    return make_placeholder(a) &&
           (a->pipelines[variant].id ||
            gpu_compute_pipeline_create(gpu, "frame.antialias", &shader_composite_antialias_comp,
                                        constants, ANTIALIAS_CONSTANT_COUNT,
                                        &a->pipelines[variant]));
}

void antialias_finish(struct antialias *a)
{
    if (!a->gpu) return;
    for (int i = 0; i < ANTIALIAS_VARIANT_COUNT; i++)
        gpu_pipeline_destroy(a->gpu, &a->pipelines[i]);
    gpu_image_destroy(a->gpu, &a->no_display);
    *a = (struct antialias){ 0 };
}

bool antialias_history_prepare(struct antialias_history *h, struct gpu *gpu, uint32_t width,
                               uint32_t height)
{
    const struct gpu_image_desc desc = { .name = "frame.antialias_history",
                                         .dimension = GPU_2D,
                                         .format = GPU_RGBA32F,
                                         .width = width,
                                         .height = height,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    for (int i = 0; i < 2; i++)
        if (!h->images[i].id && !gpu_image_create(gpu, &desc, &h->images[i])) return false;
    return true;
}

void antialias_history_finish(struct antialias_history *h, struct gpu *gpu)
{
    for (int i = 0; i < 2; i++) gpu_image_destroy(gpu, &h->images[i]);
    *h = (struct antialias_history){ 0 };
}

uint64_t antialias_history_bytes(uint32_t width, uint32_t height)
{
    return 2 * (uint64_t)width * height * (uint64_t)gpu_format_bytes(GPU_RGBA32F);
}

void antialias_record(const struct antialias *a, struct gpu_cmd *cmd, uint32_t variant,
                      struct antialias_history *h, uint32_t most,
                      const struct antialias_images *images, const struct gpu_binding bindings[2],
                      uint32_t width, uint32_t height)
{
    const struct antialias_push push = { most };
    const gpu_image last = h->images[h->newest];
    h->newest = 1 - h->newest;
    gpu_dispatch(
        cmd, a->pipelines[variant],
        GPU_BIND(bindings[0], bindings[1], { "radiance_layer", .image = images->radiance },
                 { "depth_layer", .image = images->depth },
                 { "motion_layer", .image = images->motion }, { "last_history", .image = last },
                 { "history", .image = h->images[h->newest] },
                 { "color_layer", .image = images->color },
                 { "display_layer",
                   .image = variant & ANTIALIAS_DISPLAY ? images->display : a->no_display }),
        &push, sizeof push, gpu_groups(width, 8), gpu_groups(height, 8), 1);
}
