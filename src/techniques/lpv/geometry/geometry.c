// The geometry volume and the transmittance between cells that follows from it.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_state.h"

void lpv_geometry_invalidate(struct lpv *lpv)
{
    lpv->geometry.statics.valid = false;
}

static void record_transmittance(struct lpv *lpv, struct gpu_cmd *cmd)
{
    const struct lpv_volumes *v = &lpv->volumes;
    lpv_dispatch_cells(
        lpv, cmd, lpv->pipelines.geometry_transmittance, 1,
        GPU_BIND(lpv_grid_binding(lpv, cmd),
                 { .name = "geometry", .image = v->geometry, .sampler = lpv->linear },
                 { .name = "lpv_transmittance", .buffer = v->transmittance }));
}

void lpv_record_geometry(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    bool changed = true;
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return;
    gpu_scope_begin(cmd, "geometry");
    if (lpv->options.geometry == LPV_GEOMETRY_MAPS)
        lpv_record_geometry_maps(lpv, cmd, view);
    else
        changed = lpv_record_geometry_scene(lpv, cmd, view);
    if (changed || lpv->geometry.occlusion != lpv->options.occlusion)
        record_transmittance(lpv, cmd);
    lpv->geometry.occlusion = lpv->options.occlusion;
    gpu_scope_end(cmd);
}
