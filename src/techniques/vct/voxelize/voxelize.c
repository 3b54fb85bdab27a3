// Static draws are voxelized once, moving draws in every frame. Each set takes three passes over
// its triangles: the first marks the occupied voxels, which then get slots in compact lists; the
// second finds the outermost surfaces of their faces; the third accumulates the attributes of
// these.
#include "techniques/vct/voxelize/voxelize.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

#include "frame/scene/scene_gpu.h"

static enum vct_draw_kind kind_of(const struct vct *vct, const struct scene_gpu *scene, int index)
{
    const struct scene_draw *draw = &scene->draws[index];
    const vec3s emissive = scene->scene->materials[draw->material].emissive;
    if (draw->variant & VARIANT_MASKED) return VCT_MASKED;
    if (vct->options.occlusion) return VCT_PLAIN; // colours do not matter
    const uint32_t maps =
        VARIANT_BASE_COLOR_MAP | VARIANT_METALLIC_ROUGHNESS_MAP | VARIANT_EMISSIVE_MAP;
    const bool small_emitter = vct_small_emitters_have(&vct->small_emitters, index);
    if (draw->variant & maps) return small_emitter ? VCT_TEXTURED_SMALL_EMITTER : VCT_TEXTURED;
    if (small_emitter) return VCT_SMALL_EMITTER;
    return emissive.x > 0.0f || emissive.y > 0.0f || emissive.z > 0.0f ? VCT_EMISSIVE : VCT_PLAIN;
}

// Whether a draw may touch a grid. The grid of the whole scene contains all draws.
static bool may_touch(const struct scene_draw *draw, const struct vct_grid *grid)
{
    for (int axis = 0; axis < 3; axis++) {
        const float low = grid->origin_m.raw[axis],
                    high = low + (float)grid->cells[axis] * grid->cell_m;
        const bool at_low = grid->first[axis] == 0,
                   at_high = grid->first[axis] + grid->cells[axis] == grid->scene[axis];
        // With a voxel of margin for rounding.
        if (!at_low && draw->bounds.max.raw[axis] < low - grid->cell_m) return false;
        if (!at_high && draw->bounds.min.raw[axis] > high + grid->cell_m) return false;
    }
    return true;
}

enum pass { MARK, FIND_OUTERMOST, ADD };

static const struct vct_voxelize_pipelines *pipelines_of(const struct vct *vct, enum pass pass,
                                                         enum vct_draw_kind kind)
{
    return pass == MARK  ? &vct->mark
           : pass == ADD ? &vct->add[kind]
                         : &vct->outermost[kind == VCT_MASKED];
}

// A pass over the triangles of the moving or of the static draws: small triangles, then the queued
// tiles of large ones; or all by raster, a pixel for each column.
static void traverse(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                     const struct frame_view *view, bool moving, enum pass pass,
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
        if (draw->dynamic != moving || !may_touch(draw, &clip->grid)) continue;
        const enum vct_draw_kind kind = kind_of(vct, view->scene, i);
        const struct vct_voxelize_pipelines *pipelines = pipelines_of(vct, pass, kind);
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
                 const struct frame_view *view, const struct vct_voxel_set *set, bool moving)
{
    const struct gpu_binding bindings[] = {
        vct_grid_binding(vct, clip, cmd),
        { .name = "vct_queue_state", .buffer = vct->queue_state },
        { .name = "vct_queue", .buffer = vct->queue },
        { .name = "vct_mask", .buffer = set->mask },
        { .name = "vct_accumulated", .buffer = set->accumulated }
    };
    gpu_scope_begin(cmd, "mark");
    gpu_fill_buffer(cmd, set->mask, 0, gpu_buffer_bytes(vct->gpu, set->mask), 0);
    gpu_fill_buffer(cmd, set->accumulated, 0, gpu_buffer_bytes(vct->gpu, set->accumulated), 0);
    traverse(vct, clip, cmd, view, moving, MARK, bindings, 5);
    gpu_scope_end(cmd);
}

static void make_list(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                      const struct vct_voxel_set *set)
{
    const uint32_t blocks = (uint32_t)(gpu_buffer_bytes(vct->gpu, set->blocks) / sizeof(uint32_t));
    const struct gpu_binding grid = vct_grid_binding(vct, clip, cmd);
    gpu_scope_begin(cmd, "list");
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
                          { .name = "vct_word_offsets", .buffer = set->word_offsets },
                          { .name = "vct_list", .buffer = set->list },
                          { .name = "vct_accumulated", .buffer = set->accumulated },
                          { .name = "vct_accumulated_list", .buffer = set->accumulated_list },
                          { .name = "vct_arguments", .buffer = set->arguments }),
                 NULL, 0, gpu_groups(blocks, VCT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

// A pass over the voxels whose triangles are summed up.
static void each_accumulated(const struct vct *vct, struct gpu_cmd *cmd,
                             const struct vct_voxel_set *set, gpu_pipeline pipeline)
{
    gpu_dispatch_indirect(
        cmd, pipeline,
        GPU_BIND({ .name = "vct_arguments", .buffer = set->arguments },
                 { .name = "vct_accumulated_list", .buffer = set->accumulated_list },
                 { .name = "vct_sum_words", .buffer = vct->sums },
                 { .name = "vct_surfaces", .image = set->surfaces }),
        NULL, 0, set->arguments, offsetof(struct vct_voxel_counts, accumulated_groups));
}

static void accumulate(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                       const struct frame_view *view, const struct vct_voxel_set *set, bool moving)
{
    const struct gpu_binding bindings[] = {
        vct_grid_binding(vct, clip, cmd),
        { .name = "vct_queue_state", .buffer = vct->queue_state },
        { .name = "vct_queue", .buffer = vct->queue },
        { .name = "vct_mask", .buffer = set->mask },
        { .name = "vct_word_offsets", .buffer = set->word_offsets },
        { .name = "vct_accumulated", .buffer = set->accumulated },
        { .name = "vct_sum_words", .buffer = vct->sums },
        { .name = "vct_surfaces", .image = set->surfaces }
    };
    gpu_scope_begin(cmd, "outermost");
    each_accumulated(vct, cmd, set, vct->zero);
    traverse(vct, clip, cmd, view, moving, FIND_OUTERMOST, bindings, 7);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "add");
    traverse(vct, clip, cmd, view, moving, ADD, bindings, 8);
    each_accumulated(vct, cmd, set, vct->surfaces);
    gpu_scope_end(cmd);
}

static void voxelize(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                     const struct frame_view *view, const struct vct_voxel_set *set, bool moving)
{
    mark(vct, clip, cmd, view, set, moving);
    make_list(vct, clip, cmd, set);
    accumulate(vct, clip, cmd, view, set, moving);
}

static void voxelize_level(struct vct *vct, struct vct_clip *clip, struct gpu_cmd *cmd,
                           const struct frame_view *view)
{
    const int moving = view->scene->dynamic_count;
    clip->new_statics = !clip->static_valid || view->scene->static_set != vct->static_set;
    if (clip->new_statics) voxelize(vct, clip, cmd, view, &clip->static_set, false);
    // A set whose last draw is gone is emptied once.
    clip->revoxelized =
        clip->new_statics || (moving > 0 && !vct->kept.still) || moving != vct->moving_draws;
    if (clip->revoxelized) voxelize(vct, clip, cmd, view, &clip->dynamic_set, true);
    clip->static_valid = true;
}

void vct_voxelize(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    for (int i = 0; i < vct->clip_count; i++) voxelize_level(vct, &vct->clips[i], cmd, view);
    vct->moving_draws = view->scene->dynamic_count;
    vct->static_set = view->scene->static_set;
}
