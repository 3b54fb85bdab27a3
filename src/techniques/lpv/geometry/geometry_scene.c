// The geometry volume of all triangles of the scene, independent of camera and lights. Coverage of
// static geometry is cached from frame to frame.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_state.h"
#include "techniques/lpv/lpv_volumes.h"

#include "frame/scene/scene_gpu.h"

static void record_coverage(struct lpv *lpv, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                            bool (*wanted)(const struct scene_draw *draw), gpu_buffer coverage)
{
    const struct lpv_pipelines *p = &lpv->pipelines;
    gpu_fill_buffer(cmd, coverage, 0, lpv_cell_count(&lpv->grid) * LPV_COVERAGE_BYTES, 0);
    lpv_dispatch_triangles(lpv, cmd, scene, p->geometry_coverage, p->masked_coverage, wanted,
                           "lpv_coverage", coverage);
}

bool lpv_record_geometry_scene(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct lpv_volumes *v = &lpv->volumes;
    const struct lpv_statics now = lpv_statics_of(lpv, view);
    const bool same_static = lpv_statics_equal(&lpv->geometry.statics, &now);
    lpv->geometry.statics = now;
    if (same_static && (now.moving_count == 0 || lpv->kept.still)) return false;
    if (!same_static) record_coverage(lpv, cmd, view->scene, lpv_is_static, v->static_coverage);
    record_coverage(lpv, cmd, view->scene, lpv_is_moving, v->moving_coverage);
    lpv_dispatch_cells(lpv, cmd, lpv->pipelines.geometry_faces, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_static_coverage", .buffer = v->static_coverage },
                                { .name = "lpv_moving_coverage", .buffer = v->moving_coverage },
                                { .name = "geometry", .image = v->geometry },
                                { .name = "lpv_walls", .buffer = v->walls }));
    return true;
}
