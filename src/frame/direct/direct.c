// Host code of the direct light pass.
#include "frame/direct/direct.h"

#include "frame_shaders.h"

#include <stddef.h>

bool direct_init(struct direct *d, struct gpu *gpu, uint32_t cascades)
{
    *d = (struct direct){ .gpu = gpu, .cascades = cascades };
    struct gpu_sampler_desc nearest = {
        .name = "frame.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    return gpu_sampler_get(gpu, &nearest, &d->nearest);
}

uint32_t direct_variant(int suns, int locals, uint32_t features)
{
    return (suns > 0 ? 1u << DIRECT_CONSTANT_SUNS : 0) |
           (locals > 0 ? 1u << DIRECT_CONSTANT_LOCALS : 0) |
           (suns == 1 && locals == 0 ? 1u << DIRECT_CONSTANT_ONE_SUN : 0) | features;
}

uint32_t direct_variant_of_blocks(uint32_t variant)
{
    const bool sharp_sun =
        variant >> DIRECT_CONSTANT_ONE_SUN & ~variant >> DIRECT_CONSTANT_FILTERED & 1u;
    return sharp_sun ? variant | 1u << DIRECT_CONSTANT_BLOCKS : 0;
}

static bool prepare_pipeline(struct direct *d, uint32_t variant)
{
    if (d->pipelines[variant].id) return true;
    struct gpu_constant constants[DIRECT_CONSTANT_BITS + 1];
    gpu_constants_of_bits(variant, constants, DIRECT_CONSTANT_BITS);
    constants[DIRECT_CONSTANT_BITS] =
        (struct gpu_constant){ DIRECT_CONSTANT_CASCADES, d->cascades };
    const struct gpu_shader *shader =
        variant & DIRECT_IRRADIANCE ? &shader_direct_irradiance_comp : &shader_direct_plain_comp;
    return gpu_compute_pipeline_create(d->gpu, "frame.direct", shader, constants,
                                       DIRECT_CONSTANT_BITS + 1, &d->pipelines[variant]);
}

static bool prepare_list(struct direct *d, size_t pixels)
{
    const size_t bytes = sizeof(struct direct_list_header) + pixels * sizeof(uint32_t);
    if (d->list.id && gpu_buffer_bytes(d->gpu, d->list) == bytes) return true;
    const struct gpu_buffer_desc desc = { "frame.direct_list", bytes,
                                          GPU_BUFFER_STORAGE | GPU_BUFFER_INDIRECT };
    gpu_buffer_destroy(d->gpu, &d->list);
    return gpu_buffer_create(d->gpu, &desc, &d->list);
}

static bool prepare_undecided(struct direct *d, uint32_t variant)
{
    const bool irradiance = variant & DIRECT_IRRADIANCE, emission = variant & DIRECT_EMISSION;
    const struct gpu_constant constants[] = { { DIRECT_CONSTANT_CASCADES, d->cascades },
                                              { DIRECT_CONSTANT_EMISSION, emission } };
    const struct gpu_shader *shader =
        irradiance ? &shader_direct_undecided_irradiance_comp : &shader_direct_undecided_plain_comp;
    gpu_pipeline *pipeline = &d->undecided[irradiance][emission];
    return pipeline->id || gpu_compute_pipeline_create(d->gpu, "frame.direct_undecided", shader,
                                                       constants, 2, pipeline);
}

bool direct_prepare(struct direct *d, uint32_t variant, size_t pixels)
{
    const uint32_t blocks = direct_variant_of_blocks(variant);
    // Every binding of the shader needs a buffer: that of a pixel where there is no list.
    return prepare_pipeline(d, variant) && prepare_list(d, blocks ? pixels : 1) &&
           (!blocks || (prepare_pipeline(d, blocks) && prepare_undecided(d, blocks)));
}

bool direct_compile(struct gpu *compiler, uint32_t variant, uint32_t cascades)
{
    struct direct scratch = { .gpu = compiler, .cascades = cascades };
    const uint32_t blocks = direct_variant_of_blocks(variant);
    return prepare_pipeline(&scratch, variant) &&
           (!blocks || (prepare_pipeline(&scratch, blocks) && prepare_undecided(&scratch, blocks)));
}

// No pixels, and 0 x 1 x 1 groups.
static void clear_list(const struct direct *d, struct gpu_cmd *cmd)
{
    const size_t ones = offsetof(struct direct_list_header, groups[1]);
    gpu_fill_buffer(cmd, d->list, 0, ones, 0);
    gpu_fill_buffer(cmd, d->list, ones, sizeof(struct direct_list_header) - ones, 1);
}

// Every binding needs an image.
static gpu_image emissive_or_other(const struct direct_input *in)
{
    return in->emissive.id ? in->emissive : in->normal;
}

// The shadow test of the pixels in the list.
static void record_undecided(const struct direct *d, struct gpu_cmd *cmd,
                             const struct direct_input *in, gpu_image out, gpu_image irradiance)
{
    const bool has_irradiance = in->variant & DIRECT_IRRADIANCE;
    const bool has_emission = in->variant & DIRECT_EMISSION;
    gpu_dispatch_indirect(
        cmd, d->undecided[has_irradiance][has_emission],
        GPU_BIND(in->constants, in->shadow_sun,
                 { "shadow_sun_depths", .image = in->shadow_sun_maps, .sampler = d->nearest },
                 { "shadow_blocks", .image = in->shadow_blocks, .sampler = d->nearest },
                 { "depth_layer", .image = in->depth, .sampler = d->nearest },
                 { "normal_layer", .image = in->normal, .sampler = d->nearest },
                 { "emissive_layer", .image = emissive_or_other(in), .sampler = d->nearest },
                 { "direct_list", .buffer = d->list }, { "direct_layer", .image = out },
                 { "direct_irradiance_layer", .image = irradiance }),
        NULL, 0, d->list, offsetof(struct direct_list_header, groups));
}

void direct_record(const struct direct *d, struct gpu_cmd *cmd, const struct direct_input *in,
                   gpu_image out, gpu_image irradiance)
{
    struct direct_push push = { in->shadow_radius };
    const bool has_dielectric = in->dielectric.id != 0;
    const bool has_list = in->variant >> DIRECT_CONSTANT_BLOCKS & 1u;
    gpu_scope_begin(cmd, "direct");
    if (has_list) clear_list(d, cmd);
    gpu_dispatch(
        cmd, d->pipelines[in->variant],
        GPU_BIND(in->constants, in->lights, in->shadow_faces, in->shadow_sun,
                 { "shadow_maps", .image = in->shadow_maps, .sampler = in->shadow_sampler },
                 { "shadow_sun_maps", .image = in->shadow_sun_maps, .sampler = in->shadow_sampler },
                 { "shadow_depths", .image = in->shadow_maps, .sampler = d->nearest },
                 { "shadow_sun_depths", .image = in->shadow_sun_maps, .sampler = d->nearest },
                 { "depth_layer", .image = in->depth, .sampler = d->nearest },
                 { "normal_layer", .image = in->normal, .sampler = d->nearest },
                 { "albedo_layer", .image = in->albedo, .sampler = d->nearest },
                 { "material_layer", .image = in->material, .sampler = d->nearest },
                 // Every binding needs an image.
                 { "dielectric_layer", .image = has_dielectric ? in->dielectric : in->material,
                   .sampler = d->nearest },
                 { "emissive_layer", .image = emissive_or_other(in), .sampler = d->nearest },
                 in->ggx_albedo, in->environment_map,
                 { "shadow_blocks", .image = in->shadow_blocks, .sampler = d->nearest },
                 { "direct_list", .buffer = d->list }, { "direct_layer", .image = out },
                 { "direct_irradiance_layer", .image = irradiance }),
        &push, sizeof push, gpu_groups(in->width, 8), gpu_groups(in->height, 8), 1);
    if (has_list) record_undecided(d, cmd, in, out, irradiance);
    gpu_scope_end(cmd);
}

void direct_finish(struct direct *d)
{
    for (int i = 0; d->gpu && i < DIRECT_VARIANTS; i++)
        gpu_pipeline_destroy(d->gpu, &d->pipelines[i]);
    for (int i = 0; d->gpu && i < 4; i++) gpu_pipeline_destroy(d->gpu, &d->undecided[i / 2][i % 2]);
    if (d->gpu) gpu_buffer_destroy(d->gpu, &d->list);
    *d = (struct direct){ 0 };
}
