#include "techniques/lpv/lpv_bindings.h"

#include "techniques/lpv/lpv_frame.h"

#include "frame/scene/scene_gpu.h"

struct gpu_binding lpv_grid_binding(const struct lpv_cascade *cascade, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "lpv_grid", &cascade->params, sizeof cascade->params);
}

// Invocations in the order of cells: rows of 8 by 8 would leave half of them idle in small grids.
static uint32_t groups_of_cells(const struct lpv_cascade *cascade, uint32_t run)
{
    const int32_t *cells = cascade->grid.cells;
    const uint32_t columns = (uint32_t)cells[0] * (uint32_t)cells[1];
    return gpu_groups(columns * gpu_groups((uint32_t)cells[2], run), LPV_CELLS_LOCAL);
}

void lpv_dispatch_cells(const struct lpv_cascade *cascade, struct gpu_cmd *cmd,
                        gpu_pipeline pipeline, uint32_t run, const struct gpu_binding *bindings,
                        int count)
{
    gpu_dispatch(cmd, pipeline, bindings, count, NULL, 0, groups_of_cells(cascade, run), 1, 1);
}

void lpv_dispatch_cells_push(const struct lpv_cascade *cascade, struct gpu_cmd *cmd,
                             gpu_pipeline pipeline, const struct gpu_binding *bindings, int count,
                             const void *push, uint32_t push_bytes)
{
    gpu_dispatch(cmd, pipeline, bindings, count, push, push_bytes, groups_of_cells(cascade, 1), 1,
                 1);
}

void lpv_dispatch_triangles(const struct lpv_cascade *cascade, const struct lpv_frame *frame,
                            gpu_pipeline opaque, gpu_pipeline masked,
                            bool (*wanted)(const struct scene_draw *draw), const char *name,
                            gpu_buffer buffer)
{
    const struct gpu_binding own[2] = { lpv_grid_binding(cascade, frame->cmd),
                                        { .name = name, .buffer = buffer } };
    const struct scene_gpu *scene = frame->view->scene;
    for (int i = 0; scene && i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (!wanted(draw)) continue;
        scene_gpu_dispatch(scene, frame->cmd,
                           &(struct scene_dispatch_call){
                               .pipeline = draw->variant & VARIANT_MASKED ? masked : opaque,
                               .draw = draw,
                               .bindings = own,
                               .binding_count = 2,
                           });
    }
}
