// Further bounces: the light that the surfaces of each cell reflect.
#include "techniques/lpv/propagate/propagate.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

bool lpv_bounces_after(const struct lpv_frame *frame, const struct lpv_cascade *cascade, int left)
{
    const int steps = cascade->steps, bounces = frame->options->bounces, done = steps - left;
    if (cascade->coarser) return false; // it starts from light that holds all bounces
    // Bounce k of n follows step ⌊k steps / (n + 1)⌋.
    const int parts = bounces + 1;
    return left > 0 && done * parts / steps > (done - 1) * parts / steps;
}

void lpv_record_bounce(const struct lpv_propagation *propagation, const struct lpv_frame *frame,
                       const struct lpv_cascade *cascade, gpu_image arrived)
{
    lpv_dispatch_cells(
        cascade, frame->cmd, propagation->bounce, 1,
        GPU_BIND(lpv_grid_binding(cascade, frame->cmd),
                 { .name = "lpv_surfaces", .buffer = lpv_surface_areas(frame, cascade) },
                 { .name = "injected", .image = frame->injection->injected },
                 { .name = "arrived", .image = arrived, .sampler = frame->linear },
                 { .name = "sent", .image = propagation->sent },
                 { .name = "lpv_walls", .buffer = lpv_walls(frame, cascade) }));
}
