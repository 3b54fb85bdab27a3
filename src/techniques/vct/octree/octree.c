// Nodes are built from the list of occupied voxels, level by level from the root; bricks of
// radiance are filled from the leaves up (Hong 2015, sec. 2.5.3.2 and 2.5.3.3.3).
#include "techniques/vct/octree/octree.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

// ---- The tree -----------------------------------------------------------------------------------

static size_t level_offset(uint32_t depth, size_t member)
{
    return depth * sizeof(struct vct_svo_level) + member;
}

static void mark(const struct vct_svo *svo, const struct vct_frame *frame,
                 const struct vct_voxel_set *set, uint32_t depth)
{
    const struct vct_svo_push push = { .depth = depth };
    gpu_dispatch_indirect(frame->cmd, svo->mark,
                          GPU_BIND(vct_grid_binding(frame, 0), vct_svo_binding(frame),
                                   { .name = "vct_list", .buffer = set->list },
                                   { .name = "vct_arguments", .buffer = set->arguments },
                                   { .name = "vct_svo_nodes", .buffer = svo->nodes }),
                          &push, sizeof push, set->arguments, 0);
}

// A pass over blocks of nodes at a depth; the level above holds the group count.
static void over_nodes(const struct vct_svo *svo, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                       const struct gpu_binding *bindings, int count, uint32_t depth)
{
    const struct vct_svo_push push = { .depth = depth };
    if (depth == 0)
        gpu_dispatch(cmd, pipeline, bindings, count, &push, sizeof push, 1, 1, 1);
    else
        gpu_dispatch_indirect(cmd, pipeline, bindings, count, &push, sizeof push, svo->levels,
                              level_offset(depth - 1, offsetof(struct vct_svo_level, node_groups)));
}

static void subdivide(const struct vct_svo *svo, const struct vct_frame *frame, uint32_t depth)
{
    struct gpu_cmd *cmd = frame->cmd;
    const struct vct_svo_push push = { .depth = depth };
    const struct gpu_binding bindings[] = { vct_grid_binding(frame, 0),
                                            vct_svo_binding(frame),
                                            { .name = "vct_svo_nodes", .buffer = svo->nodes },
                                            { .name = "vct_svo_blocks", .buffer = svo->blocks },
                                            { .name = "vct_svo_brick_coords",
                                              .buffer = svo->brick_coords },
                                            { .name = "vct_svo_levels", .buffer = svo->levels } };
    const int count = sizeof bindings / sizeof bindings[0];
    over_nodes(svo, cmd, svo->count, bindings, count, depth);
    gpu_dispatch(cmd, svo->scan, bindings, count, &push, sizeof push, 1, 1, 1);
    over_nodes(svo, cmd, svo->subdivide, bindings, count, depth);
}

void vct_octree_build(const struct vct_svo *svo, const struct vct_frame *frame)
{
    const struct vct_level_voxels *voxels = &frame->voxels->levels[0];
    gpu_scope_begin(frame->cmd, "nodes");
    gpu_fill_buffer(frame->cmd, svo->nodes, 0, 8 * sizeof(uint32_t), 0); // an empty root
    for (uint32_t depth = 0; depth < svo->params.depths; depth++) {
        mark(svo, frame, &voxels->static_set, depth);
        if (vct_frame_moves(frame)) mark(svo, frame, &voxels->dynamic_set, depth);
        subdivide(svo, frame, depth);
    }
    gpu_scope_end(frame->cmd);
}

// ---- Radiance in the bricks ---------------------------------------------------------------------

static void over_bricks(const struct vct_svo *svo, const struct vct_frame *frame,
                        gpu_pipeline pipeline, struct vct_svo_push push, size_t groups)
{
    gpu_dispatch_indirect(frame->cmd, pipeline,
                          GPU_BIND(vct_grid_binding(frame, 0), vct_svo_binding(frame),
                                   VCT_BOTH_SETS(&frame->voxels->levels[0]),
                                   VCT_LIT_BINDINGS(frame),
                                   { .name = "light", .image = frame->volume->light },
                                   { .name = "vct_svo_nodes", .buffer = svo->nodes },
                                   { .name = "vct_svo_brick_coords", .buffer = svo->brick_coords },
                                   { .name = "vct_svo_levels", .buffer = svo->levels }),
                          &push, sizeof push, svo->levels, level_offset(push.depth, groups));
}

static void join(const struct vct_svo *svo, const struct vct_frame *frame, uint32_t depth)
{
    gpu_scope_begin(frame->cmd, "borders");
    for (uint32_t axis = 0; axis < 3; axis++)
        over_bricks(svo, frame, svo->join, (struct vct_svo_push){ .depth = depth, .axis = axis },
                    offsetof(struct vct_svo_level, side_groups));
    gpu_scope_end(frame->cmd);
}

void vct_octree_fill(const struct vct_svo *svo, const struct vct_frame *frame)
{
    struct gpu_cmd *cmd = frame->cmd;
    const uint32_t leaves = svo->params.depths - 1;
    const size_t texels = offsetof(struct vct_svo_level, texel_groups);
    gpu_scope_begin(cmd, "leaves");
    over_bricks(svo, frame, svo->fill[vct_frame_moves(frame)],
                (struct vct_svo_push){ .depth = leaves }, texels);
    gpu_scope_end(cmd);
    join(svo, frame, leaves);
    for (uint32_t depth = leaves; depth-- > 0;) {
        gpu_scope_begin(cmd, "mips");
        over_bricks(svo, frame, svo->mip, (struct vct_svo_push){ .depth = depth }, texels);
        gpu_scope_end(cmd);
        join(svo, frame, depth);
    }
}
