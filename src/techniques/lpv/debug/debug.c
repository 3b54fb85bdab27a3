#include "techniques/lpv/debug/debug.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

void lpv_record_debug(gpu_pipeline pipeline, const struct lpv_frame *frame,
                      const struct lpv_cascade *finest, uint32_t debug_view, gpu_image out)
{
    const struct frame_view *view = frame->view;
    // A flux Φ in all directions is the intensity Φ/4π; radiance as in apply.comp.
    const struct lpv_view_push push = {
        .view = debug_view,
        .radiance_scale = finest->params.irradiance_scale / (4.0f * GLM_PIf),
    };
    const gpu_image light =
        debug_view == LPV_VIEW_PROPAGATED ? finest->light : frame->injection->injected;
    const gpu_image geometry =
        frame->options->geometry == LPV_GEOMETRY_OFF ? light : finest->geometry.volume;
    gpu_scope_begin(frame->cmd, "debug");
    // Propagation may have added occluded light to `injected`.
    lpv_record_resolve(frame->injection, frame, finest);
    gpu_dispatch(frame->cmd, pipeline,
                 GPU_BIND(lpv_grid_binding(finest, frame->cmd), view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "geometry", .image = geometry, .sampler = frame->linear },
                          { .name = "volume", .image = light },
                          { .name = "debug_image", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, LPV_LOCAL),
                 gpu_groups(view->height, LPV_LOCAL), 1);
    gpu_scope_end(frame->cmd);
}
