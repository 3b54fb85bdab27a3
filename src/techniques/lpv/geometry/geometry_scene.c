// The geometry volume of all triangles of the scene, independent of camera and lights. Coverage of
// static geometry is cached from frame to frame.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_state.h"
#include "techniques/lpv/lpv_volumes.h"

#include "frame/scene_gpu.h"

static bool is_static(const struct scene_draw *draw)
{
    return !draw->dynamic;
}

static bool is_moving(const struct scene_draw *draw)
{
    return draw->dynamic;
}

static void record_coverage(struct lpv *lpv, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                            bool (*wanted)(const struct scene_draw *draw), gpu_buffer coverage)
{
    const struct lpv_pipelines *p = &lpv->pipelines;
    gpu_fill_buffer(cmd, coverage, 0, lpv_cell_count(&lpv->grid) * LPV_COVERAGE_BYTES, 0);
    lpv_dispatch_triangles(lpv, cmd, scene, p->geometry_coverage, p->masked_coverage, wanted,
                           "lpv_coverage", coverage);
}

// In the first frame of a scene no draw counts as moving yet; a draw that moves later leaves the
// static coverage.
static bool is_cached(const struct lpv *lpv, const struct frame_view *view, int moving_count)
{
    const struct lpv_geometry_cache *cache = &lpv->geometry;
    return cache->valid && view->index > 0 && cache->moving_count == moving_count &&
           lpv_grid_equal(&cache->grid, &lpv->grid);
}

bool lpv_record_geometry_scene(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct lpv_volumes *v = &lpv->volumes;
    const int moving_count = view->scene ? view->scene->dynamic_count : 0;
    const bool cached = is_cached(lpv, view, moving_count);
    if (cached && moving_count == 0) return false;
    if (!cached) record_coverage(lpv, cmd, view->scene, is_static, v->static_coverage);
    lpv->geometry.valid = true;
    lpv->geometry.moving_count = moving_count;
    lpv->geometry.grid = lpv->grid;
    record_coverage(lpv, cmd, view->scene, is_moving, v->moving_coverage);
    lpv_dispatch_cells(lpv, cmd, lpv->pipelines.geometry_faces, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_static_coverage", .buffer = v->static_coverage },
                                { .name = "lpv_moving_coverage", .buffer = v->moving_coverage },
                                { .name = "geometry", .image = v->geometry },
                                { .name = "lpv_walls", .buffer = v->walls }));
    return true;
}
