// Further bounces: the light that the surfaces of each cell reflect.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

bool lpv_bounces_after(const struct lpv *lpv, int left)
{
    const int steps = lpv->options.steps, bounces = lpv->options.bounces, done = steps - left;
    if (lpv->coarser) return false; // it starts from light that holds all bounces
    // Bounce k of n follows step ⌊k steps / (n + 1)⌋.
    const int parts = bounces + 1;
    return left > 0 && done * parts / steps > (done - 1) * parts / steps;
}

void lpv_record_bounce(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image arrived)
{
    const struct lpv_volumes *v = &lpv->volumes;
    lpv_dispatch_cells(lpv, cmd, lpv->pipelines.bounce, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_surfaces", .buffer = lpv_surfaces(lpv) },
                                { .name = "injected", .image = v->injected },
                                { .name = "arrived", .image = arrived, .sampler = lpv->linear },
                                { .name = "sent", .image = v->sent },
                                { .name = "lpv_walls", .buffer = lpv_walls(lpv) }));
}
