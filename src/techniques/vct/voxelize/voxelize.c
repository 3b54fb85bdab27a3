// Static draws are voxelized once, moving draws in every frame. Each set takes three passes over
// its triangles: the first marks the occupied voxels, which then get slots in compact lists; the
// second finds the outermost surfaces of their faces; the third accumulates the attributes of
// these.
#include "techniques/vct/voxelize/voxelize.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

#include "frame/scene/scene_gpu.h"

static enum vct_draw_kind kind_of(const struct vct_frame *frame, int index)
{
    const struct scene_gpu *scene = frame->view->scene;
    const struct scene_draw *draw = &scene->draws[index];
    const vec3s emissive = scene->scene->materials[draw->material].emissive;
    if (draw->variant & VARIANT_MASKED) return VCT_MASKED;
    if (frame->options->occlusion) return VCT_PLAIN; // colours do not matter
    const uint32_t maps =
        VARIANT_BASE_COLOR_MAP | VARIANT_METALLIC_ROUGHNESS_MAP | VARIANT_EMISSIVE_MAP;
    const bool small_emitter = vct_small_emitters_have(frame->emitters, index);
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

static const struct vct_voxelize_pipelines *pipelines_of(const struct vct_voxels *voxels,
                                                         enum pass pass, enum vct_draw_kind kind)
{
    return pass == MARK  ? &voxels->mark
           : pass == ADD ? &voxels->add[kind]
                         : &voxels->outermost[kind == VCT_MASKED];
}

// The voxels of the moving or of the static draws in a level.
struct target {
    const struct vct_voxel_set *set;
    int level;
    bool moving;
};

// A pass over the triangles of these draws: small triangles, then the queued tiles of large ones;
// or all by raster, a pixel for each column.
static void traverse(const struct vct_voxels *voxels, const struct vct_frame *frame,
                     const struct target *to, enum pass pass, const struct gpu_binding *bindings,
                     int count)
{
    const struct scene_gpu *scene = frame->view->scene;
    const struct vct_grid *grid = &frame->clipmap->levels[to->level].grid;
    const bool raster = frame->options->voxels == VCT_BY_RASTER;
    const uint32_t dim = (uint32_t)frame->options->resolution;
    if (raster)
        gpu_render_begin(frame->cmd, &(struct gpu_render_desc){ .width = dim,
                                                                .height = dim,
                                                                .reads = scene->reads,
                                                                .read_count = scene->read_count });
    for (int i = 0; i < scene->draw_count; i++) {
        const struct scene_draw *draw = &scene->draws[i];
        if (draw->dynamic != to->moving || !may_touch(draw, grid)) continue;
        const struct vct_voxelize_pipelines *pipelines =
            pipelines_of(voxels, pass, kind_of(frame, i));
        scene_gpu_dispatch(scene, frame->cmd,
                           &(struct scene_dispatch_call){ .pipeline = pipelines->small,
                                                          .rasterize = raster,
                                                          .draw = draw,
                                                          .bindings = bindings,
                                                          .binding_count = count,
                                                          .deferred = pipelines->large,
                                                          .deferred_groups = voxels->queue_state });
    }
    if (raster) gpu_render_end(frame->cmd);
}

static void mark(const struct vct_voxels *voxels, const struct vct_frame *frame,
                 const struct target *to)
{
    const struct vct_voxel_set *set = to->set;
    const size_t mask_bytes = sizeof(uint32_t) * vct_mask_words(frame->options);
    const struct gpu_binding bindings[] = {
        vct_grid_binding(frame, to->level),
        { .name = "vct_queue_state", .buffer = voxels->queue_state },
        { .name = "vct_queue", .buffer = voxels->queue },
        { .name = "vct_mask", .buffer = set->mask },
        { .name = "vct_accumulated", .buffer = set->accumulated }
    };
    gpu_scope_begin(frame->cmd, "mark");
    gpu_fill_buffer(frame->cmd, set->mask, 0, mask_bytes, 0);
    gpu_fill_buffer(frame->cmd, set->accumulated, 0, mask_bytes, 0);
    traverse(voxels, frame, to, MARK, bindings, 5);
    gpu_scope_end(frame->cmd);
}

static void make_list(const struct vct_voxels *voxels, const struct vct_frame *frame,
                      const struct target *to)
{
    const struct vct_voxel_set *set = to->set;
    struct gpu_cmd *cmd = frame->cmd;
    const uint32_t blocks = (uint32_t)vct_block_count(frame->options);
    const struct gpu_binding grid = vct_grid_binding(frame, to->level);
    gpu_scope_begin(cmd, "list");
    gpu_dispatch(cmd, voxels->count,
                 GPU_BIND({ .name = "vct_mask", .buffer = set->mask },
                          { .name = "vct_blocks", .buffer = set->blocks }),
                 NULL, 0, gpu_groups(blocks, VCT_LOCAL), 1, 1);
    gpu_dispatch(cmd, voxels->scan,
                 GPU_BIND(grid, { .name = "vct_blocks", .buffer = set->blocks },
                          { .name = "vct_arguments", .buffer = set->arguments }),
                 NULL, 0, 1, 1, 1);
    gpu_dispatch(cmd, voxels->list,
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
static void each_accumulated(const struct vct_voxels *voxels, struct gpu_cmd *cmd,
                             const struct vct_voxel_set *set, gpu_pipeline pipeline)
{
    gpu_dispatch_indirect(
        cmd, pipeline,
        GPU_BIND({ .name = "vct_arguments", .buffer = set->arguments },
                 { .name = "vct_accumulated_list", .buffer = set->accumulated_list },
                 { .name = "vct_sum_words", .buffer = voxels->sums },
                 { .name = "vct_surfaces", .image = set->surfaces }),
        NULL, 0, set->arguments, offsetof(struct vct_voxel_counts, accumulated_groups));
}

static void accumulate(const struct vct_voxels *voxels, const struct vct_frame *frame,
                       const struct target *to)
{
    const struct vct_voxel_set *set = to->set;
    const struct gpu_binding bindings[] = {
        vct_grid_binding(frame, to->level),
        { .name = "vct_queue_state", .buffer = voxels->queue_state },
        { .name = "vct_queue", .buffer = voxels->queue },
        { .name = "vct_mask", .buffer = set->mask },
        { .name = "vct_word_offsets", .buffer = set->word_offsets },
        { .name = "vct_accumulated", .buffer = set->accumulated },
        { .name = "vct_sum_words", .buffer = voxels->sums },
        { .name = "vct_surfaces", .image = set->surfaces }
    };
    gpu_scope_begin(frame->cmd, "outermost");
    each_accumulated(voxels, frame->cmd, set, voxels->zero);
    traverse(voxels, frame, to, FIND_OUTERMOST, bindings, 7);
    gpu_scope_end(frame->cmd);
    gpu_scope_begin(frame->cmd, "add");
    traverse(voxels, frame, to, ADD, bindings, 8);
    each_accumulated(voxels, frame->cmd, set, voxels->surfaces);
    gpu_scope_end(frame->cmd);
}

static void voxelize(const struct vct_voxels *voxels, const struct vct_frame *frame, int level,
                     bool moving)
{
    const struct vct_level_voxels *of = &voxels->levels[level];
    const struct target to = { moving ? &of->dynamic_set : &of->static_set, level, moving };
    mark(voxels, frame, &to);
    make_list(voxels, frame, &to);
    accumulate(voxels, frame, &to);
}

static void voxelize_level(struct vct_voxels *voxels, const struct vct_frame *frame, int level,
                           bool still)
{
    const struct scene_gpu *scene = frame->view->scene;
    const int moving = scene->dynamic_count;
    struct vct_level_voxels *of = &voxels->levels[level];
    of->new_statics = !of->static_valid || frame->clipmap->levels[level].moved ||
                      scene->static_set != voxels->static_set;
    if (of->new_statics) voxelize(voxels, frame, level, false);
    // A set whose last draw is gone is emptied once.
    of->revoxelized = of->new_statics || (moving > 0 && !still) || moving != voxels->moving_draws;
    if (of->revoxelized) voxelize(voxels, frame, level, true);
    of->static_valid = true;
}

void vct_voxelize(struct vct_voxels *voxels, const struct vct_frame *frame, bool still)
{
    voxels->revoxelized = false;
    for (int i = 0; i < frame->clipmap->count; i++) {
        voxelize_level(voxels, frame, i, still);
        voxels->revoxelized |= voxels->levels[i].revoxelized;
    }
    voxels->moving_draws = frame->view->scene->dynamic_count;
    voxels->static_set = frame->view->scene->static_set;
}

void vct_voxels_invalidate(struct vct_voxels *voxels)
{
    for (int i = 0; i < VCT_MAX_CLIPS; i++) voxels->levels[i].static_valid = false;
}
