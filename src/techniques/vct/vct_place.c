// Where the voxels of a frame lie, and what all its passes know.
#include "techniques/vct/vct_state.h"

#include "frame/scene_gpu.h"

static bool same_grid(const struct vct_grid *a, const struct vct_grid *b)
{
    bool same = a->cell_m == b->cell_m;
    for (int axis = 0; axis < 3; axis++)
        same = same && a->cells[axis] == b->cells[axis] &&
               a->origin_m.raw[axis] == b->origin_m.raw[axis];
    return same;
}

// False where there is nothing to place them over.
static bool place_grids(struct vct *vct, const struct frame_view *view)
{
    struct vct_clip *whole = &vct->clips[0];
    const struct vct_grid before = whole->grid;
    if (!vct_grid_fit(view->bounds, vct->options.resolution, &whole->grid)) return false;
    const bool known = view->index > 0 && view->pose->scene == vct->scene;
    vct->scene = view->pose->scene;
    if (!known || !same_grid(&whole->grid, &before))
        whole->rest_valid = vct->light_valid = vct->brought_valid = false;
    return true;
}

bool vct_prepare(struct vct *vct, const struct frame_view *view)
{
    vct->ready = place_grids(vct, view);
    if (!vct->ready) return false;
    const float brightest = view->scene->max_emissive;
    const float emission_fixed = brightest > 0.0f ? (float)VCT_EMISSION_ONE / brightest : 0.0f;
    vct->params = (struct vct_params){
        .dim = vct->options.resolution,
        .capacity = vct_capacity(&vct->options),
        .emission_fixed = emission_fixed,
        .emission_scaled = brightest / (float)VCT_EMISSION_ONE * view->constants->radiance_scale,
        .shadow_size = (float)view->shadow_size,
        .shadow_radius = view->shadow_radius,
        .volume_dim = (int32_t)vct_volume_dim(&vct->options),
        .light_count = vct->options.occlusion ? 0 : view->constants->light_count,
        .light_scale = 1.0f,
        .decay_per_m = vct->options.decay,
        .offset = vct->options.offset,
    };
    return true;
}

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
    return gpu_transient(cmd, "vct_grid", &params, sizeof params);
}
