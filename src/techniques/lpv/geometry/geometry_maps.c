// The geometry volume of the paper: surfels of each light's reflective shadow maps and of the
// camera's G-buffer. Each source has its own sum; the volume is their maximum.
#include "techniques/lpv/geometry/geometry.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_state.h"
#include "techniques/lpv/lpv_volumes.h"

static struct gpu_binding surfels_binding(const struct lpv *lpv)
{
    return (struct gpu_binding){ .name = "lpv_surfels", .buffer = lpv->volumes.surfels };
}

static void begin_source(struct lpv *lpv, struct gpu_cmd *cmd)
{
    gpu_fill_buffer(cmd, lpv->volumes.surfels, 0, lpv_cell_count(&lpv->grid) * LPV_SURFEL_BYTES, 0);
}

static void end_source(struct lpv *lpv, struct gpu_cmd *cmd)
{
    lpv_dispatch_cells(lpv, cmd, lpv->pipelines.geometry_merge, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd), surfels_binding(lpv),
                                { .name = "geometry", .image = lpv->volumes.geometry }));
}

static void record_camera(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    begin_source(lpv, cmd);
    gpu_dispatch(cmd, lpv->pipelines.geometry_camera,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->constants_binding, surfels_binding(lpv),
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] }),
                 NULL, 0, gpu_groups(view->width, LPV_LOCAL * LPV_TEXELS),
                 gpu_groups(view->height, LPV_LOCAL * LPV_TEXELS), 1);
    end_source(lpv, cmd);
}

static void record_light(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                         int first_face, int face_count)
{
    const uint32_t groups = gpu_groups(view->rsm_size, LPV_LOCAL * LPV_TEXELS);
    const uint32_t push = (uint32_t)first_face;
    begin_source(lpv, cmd);
    gpu_dispatch(cmd, lpv->pipelines.geometry_light,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->rsm_faces_binding, surfels_binding(lpv),
                          { .name = "rsm_depth", .image = view->rsm_depth },
                          { .name = "rsm_normal", .image = view->rsm_normal }),
                 &push, sizeof push, groups, groups, (uint32_t)face_count);
    end_source(lpv, cmd);
}

void lpv_record_geometry_maps(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_clear_image(cmd, lpv->volumes.geometry, (const float[4]){ 0.0f, 0.0f, 0.0f, 0.0f });
    record_camera(lpv, cmd, view);
    // The consecutive faces of a light do not overlap: together they are one source.
    for (int first = 0, end; first < view->rsm_face_count; first = end) {
        end = first + 1;
        while (end < view->rsm_face_count &&
               view->rsm_faces[end].light == view->rsm_faces[first].light)
            end++;
        record_light(lpv, cmd, view, first, end - first);
    }
}
