#include "techniques/vct/vct_bindings.h"

#include "techniques/vct/vct_frame.h"

struct gpu_binding vct_grid_binding(const struct vct_frame *frame, int level)
{
    const struct vct_grid *grid = &frame->clipmap->levels[level].grid;
    struct vct_params params = frame->params;
    params.origin_m = grid->origin_m;
    params.cell_m = grid->cell_m;
    params.cells_per_m = 1.0f / grid->cell_m;
    params.cells_x = grid->cells[0];
    params.cells_y = grid->cells[1];
    params.cells_z = grid->cells[2];
    params.volume_first = level * params.volume_dim;
    params.level = frame->clipmap->count - 1 - level;
    params.level_faces = vct_level_faces(frame->options);
    params.face_first = (uint32_t)level * params.level_faces;
    for (int axis = 0; axis < 3; axis++) {
        params.scene_low.raw[axis] = (float)-grid->first[axis];
        params.scene_high.raw[axis] = (float)(grid->scene[axis] - grid->first[axis]);
    }
    return gpu_transient(frame->cmd, "vct_grid", &params, sizeof params);
}

static struct gpu_binding clipmap_binding(const struct vct_frame *frame, enum vct_clip_table_of of)
{
    const struct vct_clip_table table =
        vct_clipmap_table(frame->clipmap, frame->options->resolution, of);
    return gpu_transient(frame->cmd, "vct_clipmap", &table, sizeof table);
}

struct gpu_binding vct_clipmap_binding(const struct vct_frame *frame)
{
    return clipmap_binding(frame, VCT_OF_PIXELS);
}

struct gpu_binding vct_voxel_clipmap_binding(const struct vct_frame *frame)
{
    return clipmap_binding(frame,
                           vct_has_rays(frame->options) ? VCT_OF_VOXEL_RAYS : VCT_OF_VOXEL_CONES);
}

struct gpu_binding vct_svo_binding(const struct vct_frame *frame)
{
    return gpu_transient(frame->cmd, "vct_svo", &frame->svo->params, sizeof frame->svo->params);
}

struct gpu_binding vct_small_emitters_binding(const struct vct_frame *frame)
{
    const struct vct_small_emitters *emitters = frame->emitters;
    const size_t count = emitters->count > 0 ? (size_t)emitters->count : 1; // no block is empty
    return gpu_transient(frame->cmd, "vct_small_emitters", emitters->list,
                         count * sizeof *emitters->list);
}

gpu_image vct_result(const struct vct_frame *frame)
{
    return frame->view->layers[frame->options->occlusion ? FRAME_VISIBILITY : FRAME_IRRADIANCE];
}
