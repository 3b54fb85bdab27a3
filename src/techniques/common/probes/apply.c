#include "techniques/common/probes/apply.h"

#include "frame/frame.h"
#include "techniques/common/probes/apply_shared.h"

#include "technique_shaders.h"

#include <stddef.h>

static const struct gpu_shader *shader_of(enum probe_specular specular)
{
    switch (specular) {
    case PROBE_APPLY_DIFFUSE:
        return &shader_common_probes_apply_diffuse_comp;
    case PROBE_APPLY_SPECULAR:
        return &shader_common_probes_apply_specular_comp;
    case PROBE_APPLY_RADIANCE:
        break;
    }
    return &shader_common_probes_apply_radiance_comp;
}

void probe_apply_list(size_t base, enum probe_specular specular, struct gpu_objects *out)
{
    const struct gpu_shader *shader = shader_of(specular);
    GPU_ADD(out, base,
            { GPU_SAMPLER, "probe_depth", .member = offsetof(struct probe_apply, linear) },
            { GPU_PIPELINE, "apply", offsetof(struct probe_apply, pipeline), .shader = shader });
}

void probe_apply_record(const struct probe_apply *apply, const struct probe_volume *volume,
                        struct gpu_cmd *cmd, const struct frame_view *view, bool has_map)
{
    const gpu_image *layers = view->layers;
    const struct probe_apply_push push = { volume->grid, has_map ? (int32_t)view->width : 0,
                                           layers[FRAME_DIELECTRIC].id != 0 };
    gpu_scope_begin(cmd, "apply_probes");
    gpu_dispatch(
        cmd, apply->pipeline,
        GPU_BIND(FRAME_SURFACE_BINDINGS(view),
                 { .name = "volume", .image = volume->image, .sampler = apply->linear },
                 { .name = "probe_depths", .image = volume->depth, .sampler = apply->linear },
                 { .name = "probe_radiance", .image = volume->radiance },
                 { .name = "irradiance", .image = layers[FRAME_IRRADIANCE] },
                 { .name = "specular", .image = layers[FRAME_SPECULAR] }),
        &push, sizeof push, gpu_groups(view->width, PROBE_APPLY_LOCAL),
        gpu_groups(view->height, PROBE_APPLY_LOCAL), 1);
    gpu_scope_end(cmd);
}
