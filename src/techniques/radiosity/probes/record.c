// The passes of probes.
#include "techniques/radiosity/probes/probes.h"

#include "techniques/radiosity/probes/probes_shared.h"
#include "techniques/radiosity/radiosity_shared.h"

void radiosity_probes_record_gather(struct radiosity_probes *p, struct gpu_cmd *cmd,
                                    const struct frame_view *view, gpu_image radiosity,
                                    bool emitters)
{
    const struct radiosity_probe_gather_push push = { p->volume.grid, p->count, p->entries,
                                                      emitters ? 1.0f : 0.0f };
    gpu_scope_begin(cmd, "probes");
    gpu_dispatch(cmd, p->gather,
                 GPU_BIND(view->constants_binding, { .name = "probe_table", .buffer = p->table },
                          { .name = "probe_factors", .buffer = p->factors },
                          { .name = "radiosity_sent", .image = radiosity },
                          { .name = "volume", .image = p->volume.image }),
                 &push, sizeof push, gpu_groups(push.probes, RADIOSITY_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    p->fresh = true;
}

void radiosity_probes_record_apply(const struct radiosity_probes *p, struct gpu_cmd *cmd,
                                   const struct frame_view *view, bool mapped)
{
    const gpu_image *layers = view->layers;
    const struct radiosity_probe_apply_push push = { p->volume.grid,
                                                     mapped ? (int32_t)view->width : 0,
                                                     layers[FRAME_DIELECTRIC].id != 0 };
    gpu_scope_begin(cmd, "apply_probes");
    gpu_dispatch(
        cmd, p->apply,
        GPU_BIND(FRAME_SURFACE_BINDINGS(view),
                 { .name = "volume", .image = p->volume.image, .sampler = p->linear },
                 { .name = "probe_depths", .image = p->volume.depth, .sampler = p->linear },
                 { .name = "irradiance", .image = layers[FRAME_IRRADIANCE] },
                 { .name = "specular", .image = layers[FRAME_SPECULAR] }),
        &push, sizeof push, gpu_groups(view->width, RADIOSITY_LOCAL_2D),
        gpu_groups(view->height, RADIOSITY_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
