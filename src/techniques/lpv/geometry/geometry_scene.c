// The geometry volume of all triangles of the scene, independent of camera and lights. Coverage of
// static geometry is cached from frame to frame.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"
#include "techniques/lpv/lpv_volumes.h"

#include "frame/scene/scene_gpu.h"

static void record_coverage(const struct lpv_geometry_pipelines *pipelines,
                            const struct lpv_frame *frame, const struct lpv_cascade *cascade,
                            bool (*wanted)(const struct scene_draw *draw), gpu_buffer coverage)
{
    gpu_fill_buffer(frame->cmd, coverage, 0, lpv_cell_count(&cascade->grid) * LPV_COVERAGE_BYTES,
                    0);
    lpv_dispatch_triangles(cascade, frame, pipelines->coverage, pipelines->masked_coverage, wanted,
                           "lpv_coverage", coverage);
}

bool lpv_record_geometry_scene(const struct lpv_geometry_pipelines *pipelines,
                               const struct lpv_frame *frame, struct lpv_cascade *cascade)
{
    struct lpv_geometry *g = &cascade->geometry;
    const struct lpv_statics now = lpv_statics_of(&cascade->grid, frame->view);
    const bool same_static = lpv_statics_equal(&g->statics, &now);
    g->statics = now;
    if (same_static && (now.moving_count == 0 || cascade->kept.still)) return false;
    if (!same_static) record_coverage(pipelines, frame, cascade, lpv_is_static, g->static_coverage);
    record_coverage(pipelines, frame, cascade, lpv_is_moving, g->moving_coverage);
    lpv_dispatch_cells(cascade, frame->cmd, pipelines->faces, 1,
                       GPU_BIND(lpv_grid_binding(cascade, frame->cmd),
                                { .name = "lpv_static_coverage", .buffer = g->static_coverage },
                                { .name = "lpv_moving_coverage", .buffer = g->moving_coverage },
                                { .name = "geometry", .image = g->volume },
                                { .name = "lpv_walls", .buffer = g->walls }));
    return true;
}
