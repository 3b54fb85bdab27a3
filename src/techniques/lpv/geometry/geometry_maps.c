// The geometry volume of the paper: surfels of each light's reflective shadow maps and of the
// camera's G-buffer. Each source has its own sum; the volume is their maximum.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"
#include "techniques/lpv/lpv_volumes.h"

static struct gpu_binding surfels_binding(const struct lpv_cascade *cascade)
{
    return (struct gpu_binding){ .name = "lpv_surfels", .buffer = cascade->geometry.surfels };
}

static void begin_source(const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    gpu_fill_buffer(frame->cmd, cascade->geometry.surfels, 0,
                    lpv_cell_count(&cascade->grid) * LPV_SURFEL_BYTES, 0);
}

static void end_source(const struct lpv_geometry_pipelines *pipelines,
                       const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    lpv_dispatch_cells(cascade, frame->cmd, pipelines->merge, 1,
                       GPU_BIND(lpv_grid_binding(cascade, frame->cmd), surfels_binding(cascade),
                                { .name = "geometry", .image = cascade->geometry.volume }));
}

static void record_camera(const struct lpv_geometry_pipelines *pipelines,
                          const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    const struct frame_view *view = frame->view;
    begin_source(frame, cascade);
    gpu_dispatch(frame->cmd, pipelines->camera,
                 GPU_BIND(lpv_grid_binding(cascade, frame->cmd), view->constants_binding,
                          surfels_binding(cascade),
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] }),
                 NULL, 0, gpu_groups(view->width, LPV_LOCAL * LPV_TEXELS),
                 gpu_groups(view->height, LPV_LOCAL * LPV_TEXELS), 1);
    end_source(pipelines, frame, cascade);
}

static void record_light(const struct lpv_geometry_pipelines *pipelines,
                         const struct lpv_frame *frame, const struct lpv_cascade *cascade,
                         int first_face, int face_count)
{
    const struct frame_view *view = frame->view;
    const uint32_t groups = gpu_groups(view->rsm_size, LPV_LOCAL * LPV_TEXELS);
    const uint32_t push = (uint32_t)first_face;
    begin_source(frame, cascade);
    gpu_dispatch(frame->cmd, pipelines->light,
                 GPU_BIND(lpv_grid_binding(cascade, frame->cmd), view->rsm_faces_binding,
                          surfels_binding(cascade),
                          { .name = "rsm_depth", .image = view->rsm_depth },
                          { .name = "rsm_normal", .image = view->rsm_normal }),
                 &push, sizeof push, groups, groups, (uint32_t)face_count);
    end_source(pipelines, frame, cascade);
}

void lpv_record_geometry_maps(const struct lpv_geometry_pipelines *pipelines,
                              const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    const struct frame_view *view = frame->view;
    gpu_clear_image(frame->cmd, cascade->geometry.volume,
                    (const float[4]){ 0.0f, 0.0f, 0.0f, 0.0f });
    record_camera(pipelines, frame, cascade);
    // The consecutive faces of a light do not overlap: together they are one source.
    for (int first = 0, end; first < view->rsm_face_count; first = end) {
        end = first + 1;
        while (end < view->rsm_face_count &&
               view->rsm_faces[end].light == view->rsm_faces[first].light)
            end++;
        record_light(pipelines, frame, cascade, first, end - first);
    }
}
