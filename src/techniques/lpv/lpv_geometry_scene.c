// The geometry volume from all triangles of the scene: the same wherever the camera and the lights
// are. What never moved is kept from frame to frame.
#include "techniques/lpv/lpv_state.h"

#include "frame/scene_gpu.h"

static size_t lines_bytes(const struct lpv *lpv)
{
    const int32_t *cells = lpv->grid.cells;
    return (size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2] * LPV_LINES_BYTES;
}

// Sets the lines that what moves, or what is still, crosses.
static void record_lines(struct lpv *lpv, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                         bool moves, gpu_buffer lines)
{
    const struct gpu_binding own[2] = { lpv_grid_binding(lpv, cmd),
                                        { .name = "lpv_lines", .buffer = lines } };
    gpu_fill_buffer(cmd, lines, 0, lines_bytes(lpv), 0);
    for (int i = 0; scene && i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (draw->moves != moves) continue;
        scene_gpu_dispatch(scene, cmd,
                           &(struct scene_dispatch_call){
                               .pipeline = draw->variant & VARIANT_MASKED
                                               ? lpv->geometry.masked_lines
                                               : lpv->geometry.lines,
                               .draw = draw,
                               .bindings = own,
                               .binding_count = 2,
                           });
    }
}

// Whether `still` is what it would be if it were made now. In a scene's first frame nothing is
// known to move; what does then leaves it.
static bool is_kept(const struct lpv *lpv, const struct frame_view *view, int moving_count)
{
    const struct lpv_geometry *g = &lpv->geometry;
    return g->kept && view->index > 0 && g->kept_moving_count == moving_count &&
           lpv_grid_equal(&g->kept_grid, &lpv->grid);
}

bool lpv_record_geometry_scene(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv_geometry *g = &lpv->geometry;
    const int moving_count = view->scene ? view->scene->moving_count : 0;
    const bool kept = is_kept(lpv, view, moving_count);
    if (kept && moving_count == 0) return false;
    if (!kept) record_lines(lpv, cmd, view->scene, false, g->still);
    g->kept = true;
    g->kept_moving_count = moving_count;
    g->kept_grid = lpv->grid;
    record_lines(lpv, cmd, view->scene, true, g->moving);
    lpv_dispatch_cells(lpv, cmd, g->faces, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_still", .buffer = g->still },
                                { .name = "lpv_moving", .buffer = g->moving },
                                { .name = "geometry", .image = g->volume }));
    return true;
}
