// Host code of the display pass.
#include "frame/composite/display.h"

#include "frame_shaders.h"

bool display_prepare(struct display *d, struct gpu *gpu, uint32_t variant)
{
    struct gpu_constant constants[DISPLAY_CONSTANT_COUNT];
    d->gpu = gpu;
    gpu_constants_of_bits(variant, constants, DISPLAY_CONSTANT_COUNT);
    return d->pipelines[variant].id ||
           gpu_compute_pipeline_create(gpu, "frame.display", &shader_composite_display_comp,
                                       constants, DISPLAY_CONSTANT_COUNT, &d->pipelines[variant]);
}

void display_finish(struct display *d)
{
    if (!d->gpu) return;
    for (int i = 0; i < DISPLAY_VARIANT_COUNT; i++) gpu_pipeline_destroy(d->gpu, &d->pipelines[i]);
    *d = (struct display){ 0 };
}

void display_record(const struct display *d, struct gpu_cmd *cmd, uint32_t variant, uint32_t kind,
                    const struct display_images *images, const struct gpu_binding bindings[2],
                    uint32_t width, uint32_t height)
{
    const struct display_push push = { kind };
    gpu_dispatch(cmd, d->pipelines[variant],
                 GPU_BIND(bindings[0], bindings[1], { "shown_layer", .image = images->shown },
                          { "albedo_layer", .image = images->albedo },
                          { "display_layer", .image = images->display }),
                 &push, sizeof push, gpu_groups(width, 8), gpu_groups(height, 8), 1);
}
