// The geometry volume and the transmittance between cells that follows from it.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

static void record_transmittance(const struct lpv_geometry_pipelines *pipelines,
                                 const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    const struct lpv_geometry *geometry = &cascade->geometry;
    lpv_dispatch_cells(
        cascade, frame->cmd, pipelines->transmittance, 1,
        GPU_BIND(lpv_grid_binding(cascade, frame->cmd),
                 { .name = "geometry", .image = geometry->volume, .sampler = frame->linear },
                 { .name = "lpv_transmittance", .buffer = geometry->transmittance }));
}

void lpv_record_geometry(const struct lpv_geometry_pipelines *pipelines,
                         const struct lpv_frame *frame, struct lpv_cascade *cascade)
{
    const struct lpv_options *options = frame->options;
    bool changed = true;
    if (options->geometry == LPV_GEOMETRY_OFF) return;
    gpu_scope_begin(frame->cmd, "geometry");
    if (options->geometry == LPV_GEOMETRY_MAPS)
        lpv_record_geometry_maps(pipelines, frame, cascade);
    else
        changed = lpv_record_geometry_scene(pipelines, frame, cascade);
    if (changed || cascade->geometry.occlusion != options->occlusion)
        record_transmittance(pipelines, frame, cascade);
    cascade->geometry.occlusion = options->occlusion;
    gpu_scope_end(frame->cmd);
}
