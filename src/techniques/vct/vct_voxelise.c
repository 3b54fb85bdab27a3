// Voxelisation: what stands still once, what moves in every frame. Each set of draws is walked
// twice, to see which voxels it touches and then to add up what is in them; between, the touched
// voxels get their places in compact lists.
#include "techniques/vct/vct_state.h"

#include "frame/scene_gpu.h"

static enum vct_kind kind_of(const struct scene_draw *draw)
{
    if (draw->variant & VARIANT_MASKED) return VCT_MASKED;
    const uint32_t maps =
        VARIANT_BASE_COLOR_MAP | VARIANT_METALLIC_ROUGHNESS_MAP | VARIANT_EMISSIVE_MAP;
    return draw->variant & maps ? VCT_MAPPED : VCT_PLAIN;
}

bool vct_prepare(struct vct *vct, const struct frame_view *view)
{
    const struct vct_grid before = vct->grid;
    vct->ready = vct_grid_fit(view->bounds, vct->options.resolution, &vct->grid);
    if (!vct->ready) return false;
    const struct vct_grid *grid = &vct->grid;
    bool same = grid->cell_m == before.cell_m && view->index > 0 && view->pose->scene == vct->scene;
    for (int axis = 0; axis < 3; axis++)
        same = same && grid->cells[axis] == before.cells[axis] &&
               grid->origin_m.raw[axis] == before.origin_m.raw[axis];
    if (!same) vct->rest_valid = vct->light_valid = vct->brought_valid = false;
    vct->scene = view->pose->scene;
    const float brightest = view->scene->max_emissive;
    const float emission_fixed = brightest > 0.0f ? (float)VCT_EMISSION_ONE / brightest : 0.0f;
    vct->params = (struct vct_params){
        .origin_m = grid->origin_m,
        .cell_m = grid->cell_m,
        .cells_x = grid->cells[0],
        .cells_y = grid->cells[1],
        .cells_z = grid->cells[2],
        .dim = vct->options.resolution,
        .cells_per_m = 1.0f / grid->cell_m,
        .capacity = vct_capacity(&vct->options),
        .emission_fixed = emission_fixed,
        .emission_scaled = brightest / (float)VCT_EMISSION_ONE * view->constants->radiance_scale,
        .shadow_size = (float)view->shadow_size,
        .shadow_radius = view->shadow_radius,
        .volume_dim = (int32_t)vct_volume_dim(&vct->options),
        .light_count = view->constants->light_count,
        .light_scale = 1.0f,
    };
    return true;
}

struct gpu_binding vct_grid_binding(struct vct *vct, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "vct_grid", &vct->params, sizeof vct->params);
}

// The draws that move, or those that stand, over their voxels: small triangles, then the tiles of
// large ones that these have put into the queue; or all by raster, a pixel for each column.
static void walk(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view, bool moving,
                 bool add, const struct gpu_binding *bindings, int count)
{
    const bool raster = vct->options.voxels == VCT_BY_RASTER;
    const uint32_t dim = (uint32_t)vct->options.resolution;
    if (raster)
        gpu_render_begin(cmd, &(struct gpu_render_desc){ .width = dim,
                                                         .height = dim,
                                                         .reads = view->scene->reads,
                                                         .read_count = view->scene->read_count });
    for (int i = 0; i < view->scene->draw_count; i++) {
        const struct scene_draw *draw = &view->scene->draws[i];
        if (draw->moves != moving) continue;
        const struct vct_walk *pipelines = add ? &vct->add[kind_of(draw)] : &vct->mark;
        scene_gpu_dispatch(view->scene, cmd,
                           &(struct scene_dispatch_call){ .pipeline = pipelines->small,
                                                          .drawn = raster,
                                                          .draw = draw,
                                                          .bindings = bindings,
                                                          .binding_count = count,
                                                          .rest = pipelines->large,
                                                          .rest_groups = vct->queue_state });
    }
    if (raster) gpu_render_end(cmd);
}

static void mark(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                 const struct vct_set *set, bool moving)
{
    const struct gpu_binding bindings[] = { vct_grid_binding(vct, cmd),
                                            { .name = "vct_queue_state",
                                              .buffer = vct->queue_state },
                                            { .name = "vct_queue", .buffer = vct->queue },
                                            { .name = "vct_mask", .buffer = set->mask } };
    vct_pass_begin(vct->name, cmd, "mark");
    gpu_fill_buffer(cmd, set->mask, 0, gpu_buffer_bytes(vct->gpu, set->mask), 0);
    walk(vct, cmd, view, moving, false, bindings, 4);
    gpu_scope_end(cmd);
}

static void make_list(struct vct *vct, struct gpu_cmd *cmd, const struct vct_set *set)
{
    const uint32_t blocks = (uint32_t)(gpu_buffer_bytes(vct->gpu, set->blocks) / sizeof(uint32_t));
    const struct gpu_binding grid = vct_grid_binding(vct, cmd);
    vct_pass_begin(vct->name, cmd, "list");
    gpu_dispatch(cmd, vct->count,
                 GPU_BIND({ .name = "vct_mask", .buffer = set->mask },
                          { .name = "vct_blocks", .buffer = set->blocks }),
                 NULL, 0, gpu_groups(blocks, VCT_LOCAL), 1, 1);
    gpu_dispatch(cmd, vct->scan,
                 GPU_BIND(grid, { .name = "vct_blocks", .buffer = set->blocks },
                          { .name = "vct_arguments", .buffer = set->arguments }),
                 NULL, 0, 1, 1, 1);
    gpu_dispatch(cmd, vct->list,
                 GPU_BIND(grid, { .name = "vct_mask", .buffer = set->mask },
                          { .name = "vct_blocks", .buffer = set->blocks },
                          { .name = "vct_before", .buffer = set->before },
                          { .name = "vct_list", .buffer = set->list }),
                 NULL, 0, gpu_groups(blocks, VCT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

static void add(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                const struct vct_set *set, bool moving)
{
    const struct gpu_binding bindings[] = { vct_grid_binding(vct, cmd),
                                            { .name = "vct_queue_state",
                                              .buffer = vct->queue_state },
                                            { .name = "vct_queue", .buffer = vct->queue },
                                            { .name = "vct_mask", .buffer = set->mask },
                                            { .name = "vct_before", .buffer = set->before },
                                            { .name = "vct_sums", .buffer = set->sums } };
    vct_pass_begin(vct->name, cmd, "add");
    gpu_fill_buffer(cmd, set->sums, 0, gpu_buffer_bytes(vct->gpu, set->sums), 0);
    walk(vct, cmd, view, moving, true, bindings, 6);
    gpu_scope_end(cmd);
}

static void voxelise(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                     const struct vct_set *set, bool moving)
{
    mark(vct, cmd, view, set, moving);
    make_list(vct, cmd, set);
    add(vct, cmd, view, set, moving);
}

void vct_record_voxels(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const int moving = view->scene->moving_count;
    const bool rest = !vct->rest_valid || !vct->options.keep_static || moving != vct->moving_draws;
    if (rest) voxelise(vct, cmd, view, &vct->rest, false);
    // A set that has become empty is emptied once more.
    if (moving > 0 || vct->moving_draws > 0 || rest) voxelise(vct, cmd, view, &vct->moving, true);
    vct->remade = rest || moving > 0 || vct->moving_draws > 0;
    vct->rest_valid = true;
    vct->moving_draws = moving;
    if (vct->remade) vct_record_texels(vct, cmd);
    if (vct->remade && vct_has_svo(&vct->options)) vct_svo_record_tree(vct, cmd);
}
