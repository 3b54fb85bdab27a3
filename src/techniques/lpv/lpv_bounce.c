// Further bounces: the reflecting surfaces of each cell, cached while nothing moves, and the light
// that they reflect.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_volumes.h"

#include "frame/scene_gpu.h"

static bool is_cached(const struct lpv *lpv, const struct frame_view *view)
{
    return lpv->surfaces.valid && view->index > 0 && !view->geometry_moved &&
           lpv_grid_equal(&lpv->surfaces.grid, &lpv->grid);
}

void lpv_record_surfaces(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct lpv_pipelines *p = &lpv->pipelines;
    if (lpv->options.bounces == 0 || is_cached(lpv, view)) return;
    gpu_scope_begin(cmd, "surfaces");
    gpu_fill_buffer(cmd, lpv->volumes.surfaces, 0, lpv_cell_count(&lpv->grid) * LPV_SURFACE_BYTES,
                    0);
    lpv_dispatch_triangles(lpv, cmd, view->scene, p->surfaces, p->masked_surfaces, NULL,
                           "lpv_surfaces", lpv->volumes.surfaces);
    gpu_scope_end(cmd);
    lpv->surfaces.valid = true;
    lpv->surfaces.grid = lpv->grid;
}

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
                                { .name = "lpv_surfaces", .buffer = v->surfaces },
                                { .name = "injected", .image = v->injected },
                                { .name = "arrived", .image = arrived, .sampler = lpv->linear },
                                { .name = "sent", .image = v->sent },
                                { .name = "lpv_walls", .buffer = lpv_walls(lpv) }));
}
