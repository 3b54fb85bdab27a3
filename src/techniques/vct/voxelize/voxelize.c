// Voxelisation: what stands still once, what moves in every frame. Each set of draws is walked
// twice, to see which voxels it touches and then what is in them; between, the touched voxels get
// their places in compact lists.
#include "techniques/vct/vct_state.h"

#include "frame/scene_gpu.h"

static enum vct_kind kind_of(const struct vct *vct, const struct scene_gpu *scene, int index)
{
    const struct scene_draw *draw = &scene->draws[index];
    const vec3s glow = scene->scene->materials[draw->material].emissive;
    if (draw->variant & VARIANT_MASKED) return VCT_MASKED;
    if (vct->options.occlusion) return VCT_PLAIN; // whatever its colour
    const uint32_t maps =
        VARIANT_BASE_COLOR_MAP | VARIANT_METALLIC_ROUGHNESS_MAP | VARIANT_EMISSIVE_MAP;
    if (draw->variant & maps) return VCT_MAPPED;
    if (vct_lamps_have(&vct->lamps, index)) return VCT_LAMP;
    return glow.x > 0.0f || glow.y > 0.0f || glow.z > 0.0f ? VCT_GLOWING : VCT_PLAIN;
}

// Whether something of a draw may be in a grid. All of it is in the whole scene's.
static bool meets(const struct scene_draw *draw, const struct vct_grid *grid)
{
    for (int axis = 0; axis < 3; axis++) {
        const float low = grid->origin_m.raw[axis],
                    high = low + (float)grid->cells[axis] * grid->cell_m;
        const bool begins = grid->first[axis] == 0,
                   ends = grid->first[axis] + grid->cells[axis] == grid->scene[axis];
        // A voxel more: for rounding.
        if (!begins && draw->bounds.max.raw[axis] < low - grid->cell_m) return false;
        if (!ends && draw->bounds.min.raw[axis] > high + grid->cell_m) return false;
    }
    return true;
}

// The draws that move, or those that stand, over their voxels: small triangles, then the tiles of
// large ones that these have put into the queue; or all by raster, a pixel for each column.
static void walk(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                 const struct frame_view *view, bool moving, bool add,
                 const struct gpu_binding *bindings, int count)
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
        if (draw->moves != moving || !meets(draw, &clip->grid)) continue;
        const enum vct_kind kind = kind_of(vct, view->scene, i);
        const struct vct_walk *pipelines = add ? &vct->add[kind] : &vct->mark;
        scene_gpu_dispatch(view->scene, cmd,
                           &(struct scene_dispatch_call){ .pipeline = pipelines->small,
                                                          .rasterize = raster,
                                                          .draw = draw,
                                                          .bindings = bindings,
                                                          .binding_count = count,
                                                          .deferred = pipelines->large,
                                                          .deferred_groups = vct->queue_state });
    }
    if (raster) gpu_render_end(cmd);
}

static void mark(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                 const struct frame_view *view, const struct vct_set *set, bool moving)
{
    const struct gpu_binding bindings[] = { vct_grid_binding(vct, clip, cmd),
                                            { .name = "vct_queue_state",
                                              .buffer = vct->queue_state },
                                            { .name = "vct_queue", .buffer = vct->queue },
                                            { .name = "vct_mask", .buffer = set->mask },
                                            { .name = "vct_again", .buffer = set->again } };
    vct_pass_begin(vct->name, cmd, "mark");
    gpu_fill_buffer(cmd, set->mask, 0, gpu_buffer_bytes(vct->gpu, set->mask), 0);
    gpu_fill_buffer(cmd, set->again, 0, gpu_buffer_bytes(vct->gpu, set->again), 0);
    walk(vct, clip, cmd, view, moving, false, bindings, 5);
    gpu_scope_end(cmd);
}

static void make_list(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                      const struct vct_set *set)
{
    const uint32_t blocks = (uint32_t)(gpu_buffer_bytes(vct->gpu, set->blocks) / sizeof(uint32_t));
    const struct gpu_binding grid = vct_grid_binding(vct, clip, cmd);
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
                          { .name = "vct_list", .buffer = set->list },
                          { .name = "vct_again", .buffer = set->again },
                          { .name = "vct_again_list", .buffer = set->again_list },
                          { .name = "vct_arguments", .buffer = set->arguments }),
                 NULL, 0, gpu_groups(blocks, VCT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

// A pass over the voxels that have sums.
static void each_again(struct gpu_cmd *cmd, const struct vct_set *set, gpu_pipeline pipeline)
{
    gpu_dispatch_indirect(cmd, pipeline,
                          GPU_BIND({ .name = "vct_arguments", .buffer = set->arguments },
                                   { .name = "vct_again_list", .buffer = set->again_list },
                                   { .name = "vct_sum_words", .buffer = set->sums },
                                   { .name = "vct_surfaces", .image = set->surfaces }),
                          NULL, 0, set->arguments, offsetof(struct vct_voxel_counts, again_groups));
}

static void add(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                const struct frame_view *view, const struct vct_set *set, bool moving)
{
    const struct gpu_binding bindings[] = { vct_grid_binding(vct, clip, cmd),
                                            { .name = "vct_queue_state",
                                              .buffer = vct->queue_state },
                                            { .name = "vct_queue", .buffer = vct->queue },
                                            { .name = "vct_mask", .buffer = set->mask },
                                            { .name = "vct_before", .buffer = set->before },
                                            { .name = "vct_again", .buffer = set->again },
                                            { .name = "vct_sum_words", .buffer = set->sums },
                                            { .name = "vct_surfaces", .image = set->surfaces } };
    vct_pass_begin(vct->name, cmd, "add");
    each_again(cmd, set, vct->zero);
    walk(vct, clip, cmd, view, moving, true, bindings, 8);
    each_again(cmd, set, vct->surfaces);
    gpu_scope_end(cmd);
}

static void voxelise(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                     const struct frame_view *view, const struct vct_set *set, bool moving)
{
    mark(vct, clip, cmd, view, set, moving);
    make_list(vct, clip, cmd, set);
    add(vct, clip, cmd, view, set, moving);
}

// Voxels of one grid, where they are not kept. Whether there are new ones.
static bool make_voxels(struct vct *vct, struct vct_clip *clip, struct gpu_cmd *cmd,
                        const struct frame_view *view)
{
    const int moving = view->scene->moving_count;
    const bool rest = !clip->rest_valid || !vct->options.keep_static || moving != vct->moving_draws;
    // A set that has become empty is emptied once more.
    const bool anew = rest || moving > 0 || vct->moving_draws > 0;
    if (rest) voxelise(vct, clip, cmd, view, &clip->rest, false);
    if (anew) voxelise(vct, clip, cmd, view, &clip->moving, true);
    clip->rest_valid = true;
    if (anew) vct_record_texels(vct, clip, cmd);
    return anew;
}

void vct_record_voxels(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    vct->remade = false;
    for (int i = 0; i < vct->clip_count; i++)
        if (make_voxels(vct, &vct->clips[i], cmd, view)) vct->remade = true;
    vct->moving_draws = view->scene->moving_count;
    if (vct->remade && vct_has_svo(&vct->options)) vct_svo_record_tree(vct, cmd);
}
