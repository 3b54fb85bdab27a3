// Host code of the direct light pass.
#include "frame/direct/direct.h"

#include "frame/direct/direct_shared.h"

#include "frame_shaders.h"

bool direct_init(struct direct *d, struct gpu *gpu)
{
    static const struct gpu_constant unlit[] = { { DIRECT_CONSTANT_HAS_LIGHTS, false } };
    static const struct gpu_constant dielectric[] = { { DIRECT_CONSTANT_DIELECTRIC, true } };
    *d = (struct direct){ .gpu = gpu };
    struct gpu_sampler_desc nearest = {
        .name = "frame.nearest", .wrap_u = GPU_CLAMP, .wrap_v = GPU_CLAMP, .wrap_w = GPU_CLAMP
    };
    return gpu_sampler_get(gpu, &nearest, &d->nearest) &&
           gpu_compute_pipeline_create(gpu, "frame.direct", &shader_direct_comp, NULL, 0,
                                       &d->lit[0]) &&
           gpu_compute_pipeline_create(gpu, "frame.direct_dielectric", &shader_direct_comp,
                                       dielectric, 1, &d->lit[1]) &&
           gpu_compute_pipeline_create(gpu, "frame.direct_unlit", &shader_direct_comp, unlit, 1,
                                       &d->unlit);
}

void direct_record(const struct direct *d, struct gpu_cmd *cmd, const struct direct_input *in,
                   gpu_image out)
{
    struct direct_push push = { (float)in->shadow_size, in->shadow_radius };
    const bool has_dielectric = in->dielectric.id != 0;
    gpu_scope_begin(cmd, "direct");
    gpu_dispatch(
        cmd, in->light_count > 0 ? d->lit[has_dielectric] : d->unlit,
        GPU_BIND(in->constants, in->lights, in->shadow_faces,
                 { "shadow_maps", .image = in->shadow_maps, .sampler = in->shadow_sampler },
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
    if (d->gpu) {
        for (int i = 0; i < 2; i++) gpu_pipeline_destroy(d->gpu, &d->lit[i]);
        gpu_pipeline_destroy(d->gpu, &d->unlit);
    }
    *d = (struct direct){ 0 };
}
