// Irradiance and specular light of each pixel, cascade by cascade.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

// Coarser cascades first: each finer one blends over the pixels that it covers.
static void apply(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                  const struct lpv_grid *finer)
{
    struct lpv_apply_push push = { .open = lpv->grid.open,
                                   .coarsest = !lpv->params.boundary,
                                   .has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0 };
    if (finer) {
        push.finer_origin_m = finer->origin_m;
        push.finer_cell_m = finer->cell_m;
        push.finer_cells_x = finer->cells[0];
        push.finer_cells_y = finer->cells[1];
        push.finer_cells_z = finer->cells[2];
        push.finer_open = finer->open;
    }
    if (lpv->params.boundary) apply(lpv->coarser, cmd, view, &lpv->grid);
    const struct lpv_pipelines *p = &lpv->pipelines;
    gpu_dispatch(cmd, lpv->options.damping > 0.0f ? p->apply_damped : p->apply,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), FRAME_SURFACE_BINDINGS(view),
                          { .name = "light", .image = lpv->volumes.light, .sampler = lpv->linear },
                          { .name = "lpv_walls", .buffer = lpv_walls(lpv) },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] },
                          { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
                 &push, sizeof push, gpu_groups(view->width, LPV_LOCAL),
                 gpu_groups(view->height, LPV_LOCAL), 1);
}

void lpv_record_application(struct lpv *finest, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, "apply");
    apply(finest, cmd, view, NULL);
    gpu_scope_end(cmd);
}
