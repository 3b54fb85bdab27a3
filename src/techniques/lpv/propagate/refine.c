// The light of a coarser cascade, resampled for the next finer one.
#include "techniques/lpv/propagate/propagate.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

void lpv_record_refinement(const struct lpv_propagation *propagation, const struct lpv_frame *frame,
                           const struct lpv_cascade *cascade, gpu_image to)
{
    const struct lpv_cascade *from = cascade->coarser;
    const struct lpv_grid *grid = &cascade->grid, *coarser = &from->grid;
    const struct lpv_refine_push push = {
        .first = glms_vec3_divs(glms_vec3_sub(grid->origin_m, coarser->origin_m), coarser->cell_m),
        .ratio = grid->cell_m / coarser->cell_m,
        .cells_x = coarser->cells[0],
        .cells_y = coarser->cells[1],
        .cells_z = coarser->cells[2],
    };
    lpv_dispatch_cells_push(
        cascade, frame->cmd, propagation->refine,
        GPU_BIND(lpv_grid_binding(cascade, frame->cmd),
                 { .name = "coarser", .image = from->light, .sampler = frame->linear },
                 { .name = "refined", .image = to },
                 { .name = "lpv_walls", .buffer = lpv_walls(frame, from) }),
        &push, sizeof push);
}
