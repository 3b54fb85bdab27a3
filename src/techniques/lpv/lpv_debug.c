// Debug views.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

void lpv_record_debug(struct lpv *finest, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t debug_view, gpu_image out)
{
    const struct lpv_volumes *v = &finest->volumes;
    // A flux Φ in all directions is the intensity Φ/4π; radiance as in lpv_apply.comp.
    const struct lpv_view_push push = {
        .view = debug_view,
        .radiance_scale = finest->params.irradiance_scale / (4.0f * GLM_PIf),
    };
    const gpu_image light = debug_view == LPV_VIEW_PROPAGATED ? v->light : v->injected;
    const gpu_image geometry = finest->options.geometry == LPV_GEOMETRY_OFF ? light : v->geometry;
    gpu_scope_begin(cmd, "debug");
    lpv_record_resolve(finest, cmd); // propagation may have added occluded light to `injected`
    gpu_dispatch(cmd, finest->pipelines.debug,
                 GPU_BIND(lpv_grid_binding(finest, cmd), view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "geometry", .image = geometry, .sampler = finest->linear },
                          { .name = "volume", .image = light },
                          { .name = "debug_image", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, LPV_LOCAL),
                 gpu_groups(view->height, LPV_LOCAL), 1);
    gpu_scope_end(cmd);
}
