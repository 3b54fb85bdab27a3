// Injection: texels of reflective shadow maps and points on emissive surfaces as virtual lights.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_volumes.h"

static void inject_rsm(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const uint32_t groups = gpu_groups(view->rsm_size, LPV_LOCAL * LPV_TEXELS);
    if (view->rsm_face_count == 0) return;
    gpu_dispatch(cmd, lpv->pipelines.inject,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->rsm_faces_binding,
                          { .name = "rsm_depth", .image = view->rsm_depth },
                          { .name = "rsm_normal", .image = view->rsm_normal },
                          { .name = "rsm_flux", .image = view->rsm_flux },
                          { .name = "lpv_sums", .buffer = lpv->volumes.sums },
                          { .name = "lpv_walls", .buffer = lpv_walls(lpv) }),
                 NULL, 0, groups, groups, (uint32_t)view->rsm_face_count);
}

static void inject_emitters(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (lpv->params.emitter_count == 0) return;
    gpu_dispatch(cmd, lpv->pipelines.inject_emitters,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->emitters_binding,
                          { .name = "lpv_sums", .buffer = lpv->volumes.sums },
                          { .name = "lpv_walls", .buffer = lpv_walls(lpv) }),
                 NULL, 0, gpu_groups(lpv->params.emitter_count, LPV_EMITTERS_LOCAL), 1, 1);
}

void lpv_record_resolve(struct lpv *lpv, struct gpu_cmd *cmd)
{
    lpv_dispatch_cells(lpv, cmd, lpv->pipelines.resolve, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_sums", .buffer = lpv->volumes.sums },
                                { .name = "injected", .image = lpv->volumes.injected }));
}

void lpv_record_injection(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, "inject");
    gpu_fill_buffer(cmd, lpv->volumes.sums, 0,
                    lpv_cell_count(&lpv->grid) * lpv_sum_bytes(&lpv->options), 0);
    inject_rsm(lpv, cmd, view);
    inject_emitters(lpv, cmd, view);
    gpu_scope_end(cmd);

    gpu_scope_begin(cmd, "resolve");
    lpv_record_resolve(lpv, cmd);
    gpu_scope_end(cmd);
}
