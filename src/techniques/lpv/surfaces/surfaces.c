// The reflecting surfaces of each cell, for further bounces. Those of static draws are kept from
// frame to frame, those of moving draws are added while they move.
#include "techniques/lpv/surfaces/surfaces.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"
#include "techniques/lpv/lpv_volumes.h"

#include "frame/scene/scene_gpu.h"

#include <assert.h>

static size_t surface_bytes(const struct lpv_cascade *cascade)
{
    return lpv_cell_count(&cascade->grid) * LPV_SURFACE_BYTES;
}

static void add(const struct lpv_surface_pipelines *pipelines, const struct lpv_frame *frame,
                const struct lpv_cascade *cascade, bool (*wanted)(const struct scene_draw *draw),
                gpu_buffer to)
{
    lpv_dispatch_triangles(cascade, frame, pipelines->opaque, pipelines->masked, wanted,
                           "lpv_surfaces", to);
}

static void add_static(const struct lpv_surface_pipelines *pipelines, const struct lpv_frame *frame,
                       const struct lpv_cascade *cascade)
{
    const gpu_buffer areas = cascade->surfaces.areas;
    gpu_fill_buffer(frame->cmd, areas, 0, surface_bytes(cascade), 0);
    add(pipelines, frame, cascade, lpv_is_static, areas);
}

// Moving draws join the static ones once they rest. While they move, they join a copy; the sums of
// the injection, already resolved, have room for it.
static void add_moving(const struct lpv_surface_pipelines *pipelines, const struct lpv_frame *frame,
                       const struct lpv_cascade *cascade, bool rest)
{
    const gpu_buffer areas = cascade->surfaces.areas, sums = frame->injection->sums;
    assert(lpv_sum_bytes(frame->options) >= LPV_SURFACE_BYTES);
    if (!rest) gpu_copy_buffer(frame->cmd, sums, 0, areas, 0, surface_bytes(cascade));
    add(pipelines, frame, cascade, lpv_is_moving, rest ? areas : sums);
}

void lpv_record_surfaces(const struct lpv_surface_pipelines *pipelines,
                         const struct lpv_frame *frame, struct lpv_cascade *cascade)
{
    struct lpv_surfaces *surfaces = &cascade->surfaces;
    const struct lpv_statics now = lpv_statics_of(&cascade->grid, frame->view);
    const bool same_static = lpv_statics_equal(&surfaces->statics, &now);
    const bool rest = now.moving_count == 0 || cascade->kept.still;
    if (frame->options->bounces == 0) return;
    surfaces->statics = now;
    if (same_static && rest && surfaces->at_rest) return;
    gpu_scope_begin(frame->cmd, "surfaces");
    if (!same_static || surfaces->at_rest) add_static(pipelines, frame, cascade);
    if (now.moving_count > 0) add_moving(pipelines, frame, cascade, rest);
    gpu_scope_end(frame->cmd);
    surfaces->at_rest = rest;
}

gpu_buffer lpv_surface_areas(const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    return cascade->surfaces.at_rest ? cascade->surfaces.areas : frame->injection->sums;
}
