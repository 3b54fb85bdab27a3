// Host code of the direct light pass.
#include "frame/direct/direct.h"

#include "frame_shaders.h"

bool direct_init(struct direct *d, struct gpu *gpu, uint32_t cascades)
{
    *d = (struct direct){ .gpu = gpu, .cascades = cascades };
    struct gpu_sampler_desc nearest = {
        .name = "frame.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    return gpu_sampler_get(gpu, &nearest, &d->nearest);
}

uint32_t direct_variant(int suns, int locals, bool dielectric, bool filtered)
{
    return (suns > 0 ? 1u << DIRECT_CONSTANT_SUNS : 0) |
           (locals > 0 ? 1u << DIRECT_CONSTANT_LOCALS : 0) |
           (suns == 1 && locals == 0 ? 1u << DIRECT_CONSTANT_ONE_SUN : 0) |
           (dielectric ? 1u << DIRECT_CONSTANT_DIELECTRIC : 0) |
           (filtered ? 1u << DIRECT_CONSTANT_FILTERED : 0);
}

bool direct_prepare(struct direct *d, uint32_t variant)
{
    if (d->pipelines[variant].id) return true;
    struct gpu_constant constants[DIRECT_CONSTANT_BITS + 1];
    gpu_constants_of_bits(variant, constants, DIRECT_CONSTANT_BITS);
    constants[DIRECT_CONSTANT_BITS] =
        (struct gpu_constant){ DIRECT_CONSTANT_CASCADES, d->cascades };
    return gpu_compute_pipeline_create(d->gpu, "frame.direct", &shader_direct_comp, constants,
                                       DIRECT_CONSTANT_BITS + 1, &d->pipelines[variant]);
}

void direct_record(const struct direct *d, struct gpu_cmd *cmd, const struct direct_input *in,
                   gpu_image out)
{
    struct direct_push push = { in->shadow_radius };
    const bool has_dielectric = in->dielectric.id != 0;
    gpu_scope_begin(cmd, "direct");
    gpu_dispatch(
        cmd, d->pipelines[in->variant],
        GPU_BIND(in->constants, in->lights, in->shadow_faces, in->first_shadow_faces,
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
                 { "emissive_layer", .image = in->emissive, .sampler = d->nearest }, in->ggx_albedo,
                 { "direct_layer", .image = out }),
        &push, sizeof push, gpu_groups(in->width, 8), gpu_groups(in->height, 8), 1);
    gpu_scope_end(cmd);
}

void direct_finish(struct direct *d)
{
    for (int i = 0; d->gpu && i < DIRECT_VARIANTS; i++)
        gpu_pipeline_destroy(d->gpu, &d->pipelines[i]);
    *d = (struct direct){ 0 };
}
