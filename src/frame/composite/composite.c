// Host code of the composite pass.
#include "frame/composite/composite.h"

#include "image/exposure.h"

#include "frame_shaders.h"

static bool make_placeholder(struct composite *c, const char *name, enum gpu_format format,
                             gpu_image *out)
{
    struct gpu_image_desc desc = { .name = name,
                                   .dimension = GPU_2D,
                                   .format = format,
                                   .width = 1,
                                   .height = 1,
                                   .usage = GPU_SAMPLED | GPU_STORAGE };
    return gpu_image_create(c->gpu, &desc, out);
}

bool composite_init(struct composite *c, struct gpu *gpu)
{
    *c = (struct composite){ .gpu = gpu };
    struct gpu_sampler_desc nearest = {
        .name = "frame.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    return gpu_sampler_get(gpu, &nearest, &c->nearest) &&
           make_placeholder(c, "frame.no_radiance", GPU_RGBA16F, &c->no_radiance) &&
           make_placeholder(c, "frame.no_display", GPU_RGBA8, &c->no_display);
}

void composite_finish(struct composite *c)
{
    if (!c->gpu) return;
    for (int i = 0; i < COMPOSITE_VARIANT_COUNT; i++)
        gpu_pipeline_destroy(c->gpu, &c->pipelines[i]);
    gpu_image_destroy(c->gpu, &c->no_radiance);
    gpu_image_destroy(c->gpu, &c->no_display);
    *c = (struct composite){ 0 };
}

bool composite_prepare(struct composite *c, uint32_t variant)
{
    if (c->pipelines[variant].id) return true;
    struct gpu_constant constants[COMPOSITE_CONSTANT_COUNT];
    gpu_constants_of_bits(variant, constants, COMPOSITE_CONSTANT_COUNT);
    return gpu_compute_pipeline_create(c->gpu, "frame.composite", &shader_composite_comp, constants,
                                       COMPOSITE_CONSTANT_COUNT, &c->pipelines[variant]);
}

void composite_record(const struct composite *c, struct gpu_cmd *cmd, uint32_t variant,
                      const struct composite_images *images, const struct gpu_binding bindings[3],
                      uint32_t width, uint32_t height)
{
    // Every binding of the shader needs an image: the direct layer fills inputs that are not read.
    gpu_image irradiance = variant & COMPOSITE_IRRADIANCE ? images->irradiance : images->direct;
    gpu_image specular = variant & COMPOSITE_SPECULAR ? images->specular : images->direct;
    gpu_image visibility = variant & COMPOSITE_VISIBILITY ? images->visibility : images->direct;
    gpu_image indirect = variant & COMPOSITE_INDIRECT ? images->indirect : c->no_radiance;
    gpu_image display = variant & COMPOSITE_DISPLAY ? images->display : c->no_display;
    struct composite_push push = { 1 };
    if (variant & COMPOSITE_METER) push.stride = exposure_stride(width, height);
    width = gpu_groups(width, push.stride), height = gpu_groups(height, push.stride);
    gpu_dispatch(cmd, c->pipelines[variant],
                 GPU_BIND(bindings[0], bindings[1], bindings[2],
                          { "direct_layer", .image = images->direct, .sampler = c->nearest },
                          { "albedo_layer", .image = images->albedo, .sampler = c->nearest },
                          { "irradiance_layer", .image = irradiance, .sampler = c->nearest },
                          { "specular_layer", .image = specular, .sampler = c->nearest },
                          { "visibility_layer", .image = visibility, .sampler = c->nearest },
                          { "color_layer", .image = images->color },
                          { "indirect_layer", .image = indirect },
                          { "display_layer", .image = display }),
                 &push, sizeof push, gpu_groups(width, 8), gpu_groups(height, 8), 1);
}
