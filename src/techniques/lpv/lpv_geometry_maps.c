// The geometry volume as the paper fills it: from the reflective shadow maps of each light and from
// the camera's G-buffer, each source by itself, merged by the greatest.
#include "techniques/lpv/lpv_state.h"

static size_t area_bytes(const struct lpv *lpv)
{
    const int32_t *cells = lpv->grid.cells;
    return (size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2] * LPV_AREA_BYTES;
}

static struct gpu_binding areas_binding(const struct lpv *lpv)
{
    return (struct gpu_binding){ .name = "lpv_areas", .buffer = lpv->geometry.areas };
}

static void begin_source(struct lpv *lpv, struct gpu_cmd *cmd)
{
    gpu_fill_buffer(cmd, lpv->geometry.areas, 0, area_bytes(lpv), 0);
}

static void end_source(struct lpv *lpv, struct gpu_cmd *cmd)
{
    lpv_dispatch_cells(lpv, cmd, lpv->geometry.merge, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd), areas_binding(lpv),
                                { .name = "geometry", .image = lpv->geometry.volume }));
}

static void record_camera(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    begin_source(lpv, cmd);
    gpu_dispatch(cmd, lpv->geometry.camera,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->constants_binding, areas_binding(lpv),
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
    gpu_dispatch(cmd, lpv->geometry.light,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->rsm_faces_binding, areas_binding(lpv),
                          { .name = "rsm_depth", .image = view->rsm_depth },
                          { .name = "rsm_normal", .image = view->rsm_normal }),
                 &push, sizeof push, groups, groups, (uint32_t)face_count);
    end_source(lpv, cmd);
}

void lpv_record_geometry_maps(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_clear_image(cmd, lpv->geometry.volume, (const float[4]){ 0.0f, 0.0f, 0.0f, 0.0f });
    record_camera(lpv, cmd, view);
    // A light's faces follow each other and see nothing twice: they are one source.
    for (int first = 0, end; first < view->rsm_face_count; first = end) {
        end = first + 1;
        while (end < view->rsm_face_count &&
               view->rsm_faces[end].light == view->rsm_faces[first].light)
            end++;
        record_light(lpv, cmd, view, first, end - first);
    }
}
