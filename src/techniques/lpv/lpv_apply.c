// Irradiance and specular light of each pixel, cascade by cascade.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/common/light_map/columns.h"
#include "techniques/lpv/lpv_bindings.h"

static struct lpv_apply_push push_of(const struct lpv *lpv, const struct frame_view *view,
                                     const struct lpv_grid *finer)
{
    const struct box3 box = lpv_grid_inside(&lpv->grid, 1.0f);
    const struct box3 of_finer =
        finer ? lpv_grid_inside(finer, 1.0f + (float)LPV_TRANSITION) : box3_empty();
    return (struct lpv_apply_push){
        .low_m = box.min,
        .high_m = box.max,
        .finer_low_m = of_finer.min,
        .finer_high_m = of_finer.max,
        .coarsest = !lpv->params.boundary,
        .has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0,
        .rows = (int32_t)light_map_columns_for(lpv->gpu).rows,
    };
}

// Coarser cascades first: each finer one blends over the pixels that it covers.
static void apply(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                  const struct lpv_grid *finer)
{
    const struct lpv_apply_push push = push_of(lpv, view, finer);
    if (lpv->params.boundary) apply(lpv->coarser, cmd, view, &lpv->grid);
    const struct lpv_pipelines *p = &lpv->pipelines;
    gpu_dispatch(cmd, lpv->options.damping > 0.0f ? p->apply_damped : p->apply,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), FRAME_SURFACE_BINDINGS(view),
                          { .name = "light", .image = lpv->volumes.light, .sampler = lpv->linear },
                          { .name = "lpv_walls", .buffer = lpv_walls(lpv) },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] },
                          { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
                 &push, sizeof push, gpu_groups(view->width, LPV_APPLY_LOCAL),
                 gpu_groups(view->height, (uint32_t)push.rows), 1);
}

void lpv_record_application(struct lpv *finest, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, "apply");
    light_map_clear_pixels(cmd, view);
    apply(finest, cmd, view, NULL);
    gpu_scope_end(cmd);
}
