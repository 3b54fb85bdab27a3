#include "techniques/vct/vct_bindings.h"

#include "techniques/vct/vct_state.h"

struct gpu_binding vct_grid_binding(const struct vct *vct, const struct vct_clip *clip,
                                    struct gpu_cmd *cmd)
{
    const struct vct_grid *grid = &clip->grid;
    struct vct_params params = vct->params;
    params.origin_m = grid->origin_m;
    params.cell_m = grid->cell_m;
    params.cells_per_m = 1.0f / grid->cell_m;
    params.cells_x = grid->cells[0];
    params.cells_y = grid->cells[1];
    params.cells_z = grid->cells[2];
    const int number = (int)(clip - vct->clips);
    params.volume_first = number * params.volume_dim;
    params.level = vct->clip_count - 1 - number;
    for (int axis = 0; axis < 3; axis++) {
        params.scene_low.raw[axis] = (float)-grid->first[axis];
        params.scene_high.raw[axis] = (float)(grid->scene[axis] - grid->first[axis]);
    }
    return gpu_transient(cmd, "vct_grid", &params, sizeof params);
}

struct gpu_binding vct_svo_binding(const struct vct *vct, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "vct_svo", &vct->svo.params, sizeof vct->svo.params);
}

struct gpu_binding vct_small_emitters_binding(const struct vct *vct, struct gpu_cmd *cmd)
{
    const struct vct_small_emitters *emitters = &vct->small_emitters;
    const size_t count = emitters->count > 0 ? (size_t)emitters->count : 1; // no block is empty
    return gpu_transient(cmd, "vct_small_emitters", emitters->list, count * sizeof *emitters->list);
}

gpu_image vct_result(const struct vct *vct, const struct frame_view *view)
{
    return view->layers[vct->options.occlusion ? FRAME_VISIBILITY : FRAME_IRRADIANCE];
}
