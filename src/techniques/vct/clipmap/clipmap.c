// Where the voxels of a frame lie, and what all its passes know.
#include "techniques/vct/vct_state.h"

#include "frame/scene_gpu.h"

#include <math.h>

static bool same_grid(const struct vct_grid *a, const struct vct_grid *b)
{
    bool same = a->cell_m == b->cell_m;
    for (int axis = 0; axis < 3; axis++)
        same = same && a->cells[axis] == b->cells[axis] &&
               a->origin_m.raw[axis] == b->origin_m.raw[axis];
    return same;
}

// Texels of a grid, within the box in which it is looked into, over which it gives way to the next
// coarser one: of 13 between the eye and the border with resolution=64.
static float fade_of(const struct vct *vct)
{
    return fminf((float)vct->options.resolution / 16.0f, 4.0f);
}

// The grids about the eye, each half as wide as the last one.
static void place_about_eye(struct vct *vct, const struct frame_view *view)
{
    const struct vct_grid *scene = &vct->clips[0].grid;
    const int dim = vct->options.resolution;
    for (int i = 1; i < vct->clip_count; i++) {
        struct vct_clip *clip = &vct->clips[i];
        const struct vct_grid before = clip->grid;
        clip->grid = vct_grid_about(scene, dim, i, view->camera.eye);
        clip->used = vct_grid_used(scene, dim, i, view->camera.eye, 2.0f * fade_of(vct));
        if (!same_grid(&clip->grid, &before)) clip->rest_valid = false;
    }
}

// False where there is nothing to place them over.
static bool place_grids(struct vct *vct, const struct frame_view *view)
{
    const struct vct_grid before = vct->clips[0].grid;
    if (!vct_grid_fit(view->bounds, vct->options.resolution, &vct->clips[0].grid)) return false;
    const bool known = view->index > 0 && view->pose->scene == vct->scene;
    vct->scene = view->pose->scene;
    place_about_eye(vct, view);
    if (!known) vct->lamps.chosen = false;
    if (known && same_grid(&vct->clips[0].grid, &before)) return true;
    for (int i = 0; i < vct->clip_count; i++) vct->clips[i].rest_valid = false;
    vct->light_valid = vct->brought_valid = false;
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
    const int number = (int)(clip - vct->clips);
    params.volume_first = number * params.volume_dim;
    params.level = vct->clip_count - 1 - number;
    for (int axis = 0; axis < 3; axis++) {
        params.scene_low.raw[axis] = (float)-grid->first[axis];
        params.scene_high.raw[axis] = (float)(grid->scene[axis] - grid->first[axis]);
    }
    return gpu_transient(cmd, "vct_grid", &params, sizeof params);
}

// ---- For cones ----------------------------------------------------------------------------------

// `box`: in voxels of the grid from the scene's corner.
static struct vct_clip_level level_of(const struct vct_grid *grid, struct box3 box, int level)
{
    struct vct_clip_level out;
    const float voxel = 0.5f * (float)(1 << level); // in texels of the finest grid
    for (int axis = 0; axis < 3; axis++) {
        out.corner.raw[axis] = (float)grid->first[axis] * voxel;
        out.size.raw[axis] = (float)(grid->cells[axis] / 2);
        out.low.raw[axis] = box.min.raw[axis] * voxel;
        out.high.raw[axis] = box.max.raw[axis] * voxel;
    }
    return out;
}

// All of a grid but its outermost half texel, which is one voxel; at the scene's border nothing
// ends.
static struct box3 box_of(const struct vct_grid *grid)
{
    struct box3 box;
    for (int axis = 0; axis < 3; axis++) {
        const int32_t first = grid->first[axis], last = first + grid->cells[axis],
                      scene = grid->scene[axis];
        box.min.raw[axis] = (float)(first > 0 ? first + 1 : -scene);
        box.max.raw[axis] = (float)(last < scene ? last - 1 : 2 * scene);
    }
    return box;
}

static struct gpu_binding clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd, bool lit)
{
    const struct vct_grid *scene = lit ? &vct->clips[0].lit : &vct->clips[0].grid;
    struct vct_clip_table table = { .origin_m = scene->origin_m, .fade = fade_of(vct) };
    for (int i = 0; i < vct->clip_count; i++) {
        const struct vct_clip *clip = &vct->clips[i];
        const struct vct_grid *grid = lit ? &clip->lit : &clip->grid;
        const int level = vct->clip_count - 1 - i;
        const struct box3 box = lit || i == 0 ? box_of(grid) : clip->used;
        table.levels[level] = level_of(grid, box, level);
    }
    const int coarsest = vct->clip_count - 1;
    table.size = glms_vec3_scale(table.levels[coarsest].size, (float)(1 << coarsest));
    return gpu_transient(cmd, "vct_clipmap", &table, sizeof table);
}

struct gpu_binding vct_clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd)
{
    return clipmap_binding(vct, cmd, false);
}

struct gpu_binding vct_lit_clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd)
{
    return clipmap_binding(vct, cmd, true);
}
