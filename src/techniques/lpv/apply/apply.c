// Irradiance and specular light of each pixel, cascade by cascade.
#include "techniques/lpv/apply/apply.h"

#include "techniques/common/light_map/columns.h"
#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

static struct lpv_apply_push push_of(const struct lpv_frame *frame,
                                     const struct lpv_cascade *cascade,
                                     const struct lpv_grid *finer)
{
    const struct box3 box = lpv_grid_inside(&cascade->grid, 1.0f);
    const struct box3 of_finer =
        finer ? lpv_grid_inside(finer, 1.0f + (float)LPV_TRANSITION) : box3_empty();
    return (struct lpv_apply_push){
        .low_m = box.min,
        .high_m = box.max,
        .finer_low_m = of_finer.min,
        .finer_high_m = of_finer.max,
        .coarsest = !cascade->params.boundary,
        .has_dielectric = frame->view->layers[FRAME_DIELECTRIC].id != 0,
        .rows = (int32_t)light_map_columns_for(frame->gpu).rows,
    };
}

// Coarser cascades first: each finer one blends over the pixels that it covers.
static void apply(gpu_pipeline pipeline, const struct lpv_frame *frame,
                  const struct lpv_cascade *cascade, const struct lpv_grid *finer)
{
    const struct frame_view *view = frame->view;
    const struct lpv_apply_push push = push_of(frame, cascade, finer);
    if (cascade->params.boundary) apply(pipeline, frame, cascade->coarser, &cascade->grid);
    gpu_dispatch(frame->cmd, pipeline,
                 GPU_BIND(lpv_grid_binding(cascade, frame->cmd), FRAME_SURFACE_BINDINGS(view),
                          { .name = "light", .image = cascade->light, .sampler = frame->linear },
                          { .name = "lpv_walls", .buffer = lpv_walls(frame, cascade) },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] },
                          { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
                 &push, sizeof push, gpu_groups(view->width, LPV_APPLY_LOCAL),
                 gpu_groups(view->height, (uint32_t)push.rows), 1);
}

void lpv_record_application(const struct lpv_application *application,
                            const struct lpv_frame *frame, const struct lpv_cascade *finest)
{
    gpu_scope_begin(frame->cmd, "apply");
    light_map_clear_pixels(frame->cmd, frame->view);
    apply(frame->options->damping > 0.0f ? application->damped : application->plain, frame, finest,
          NULL);
    gpu_scope_end(frame->cmd);
}
