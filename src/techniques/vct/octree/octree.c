// Nodes are built from the list of occupied voxels, level by level from the root; bricks of
// radiance are filled from the leaves up (Hong 2015, sec. 2.5.3.2 and 2.5.3.3.3).
#include "techniques/vct/octree/octree.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

// ---- The tree -----------------------------------------------------------------------------------

static size_t level_offset(uint32_t depth, size_t member)
{
    return depth * sizeof(struct vct_svo_level) + member;
}

static void mark(struct vct *vct, struct gpu_cmd *cmd, const struct vct_voxel_set *set,
                 uint32_t depth)
{
    const struct vct_svo_push push = { .depth = depth };
    gpu_dispatch_indirect(cmd, vct->svo.mark,
                          GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd),
                                   vct_svo_binding(vct, cmd),
                                   { .name = "vct_list", .buffer = set->list },
                                   { .name = "vct_arguments", .buffer = set->arguments },
                                   { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
                          &push, sizeof push, set->arguments, 0);
}

// A pass over blocks of nodes at a depth; the level above holds the group count.
static void over_nodes(struct gpu_cmd *cmd, const struct vct_svo *svo, gpu_pipeline pipeline,
                       const struct gpu_binding *bindings, int count, uint32_t depth)
{
    const struct vct_svo_push push = { .depth = depth };
    if (depth == 0)
        gpu_dispatch(cmd, pipeline, bindings, count, &push, sizeof push, 1, 1, 1);
    else
        gpu_dispatch_indirect(cmd, pipeline, bindings, count, &push, sizeof push, svo->levels,
                              level_offset(depth - 1, offsetof(struct vct_svo_level, node_groups)));
}

static void subdivide(struct vct *vct, struct gpu_cmd *cmd, uint32_t depth)
{
    const struct vct_svo *svo = &vct->svo;
    const struct vct_svo_push push = { .depth = depth };
    const struct gpu_binding bindings[] = { vct_grid_binding(vct, &vct->clips[0], cmd),
                                            vct_svo_binding(vct, cmd),
                                            { .name = "vct_svo_nodes", .buffer = svo->nodes },
                                            { .name = "vct_svo_blocks", .buffer = svo->blocks },
                                            { .name = "vct_svo_brick_coords",
                                              .buffer = svo->brick_coords },
                                            { .name = "vct_svo_levels", .buffer = svo->levels } };
    const int count = sizeof bindings / sizeof bindings[0];
    over_nodes(cmd, svo, svo->count, bindings, count, depth);
    gpu_dispatch(cmd, svo->scan, bindings, count, &push, sizeof push, 1, 1, 1);
    over_nodes(cmd, svo, svo->subdivide, bindings, count, depth);
}

void vct_octree_build(struct vct *vct, struct gpu_cmd *cmd)
{
    gpu_scope_begin(cmd, "nodes");
    gpu_fill_buffer(cmd, vct->svo.nodes, 0, 8 * sizeof(uint32_t), 0); // an empty root
    for (uint32_t depth = 0; depth < vct->svo.params.depths; depth++) {
        mark(vct, cmd, &vct->clips[0].static_set, depth);
        if (vct->moving_draws > 0) mark(vct, cmd, &vct->clips[0].dynamic_set, depth);
        subdivide(vct, cmd, depth);
    }
    gpu_scope_end(cmd);
}

// ---- Radiance in the bricks ---------------------------------------------------------------------

static void over_bricks(struct vct *vct, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                        struct vct_svo_push push, size_t groups)
{
    gpu_dispatch_indirect(
        cmd, pipeline,
        GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd), vct_svo_binding(vct, cmd),
                 VCT_BOTH_SETS(&vct->clips[0]), { .name = "light", .image = vct->light },
                 { .name = "vct_svo_nodes", .buffer = vct->svo.nodes },
                 { .name = "vct_svo_brick_coords", .buffer = vct->svo.brick_coords },
                 { .name = "vct_svo_levels", .buffer = vct->svo.levels }),
        &push, sizeof push, vct->svo.levels, level_offset(push.depth, groups));
}

static void join(struct vct *vct, struct gpu_cmd *cmd, uint32_t depth)
{
    gpu_scope_begin(cmd, "borders");
    for (uint32_t axis = 0; axis < 3; axis++)
        over_bricks(vct, cmd, vct->svo.join, (struct vct_svo_push){ .depth = depth, .axis = axis },
                    offsetof(struct vct_svo_level, side_groups));
    gpu_scope_end(cmd);
}

void vct_octree_fill(struct vct *vct, struct gpu_cmd *cmd)
{
    const uint32_t leaves = vct->svo.params.depths - 1;
    vct->clips[0].lit_grid = vct->clips[0].grid;
    const size_t texels = offsetof(struct vct_svo_level, texel_groups);
    gpu_scope_begin(cmd, "leaves");
    over_bricks(vct, cmd, vct->svo.fill[vct->moving_draws > 0],
                (struct vct_svo_push){ .depth = leaves }, texels);
    gpu_scope_end(cmd);
    join(vct, cmd, leaves);
    for (uint32_t depth = leaves; depth-- > 0;) {
        gpu_scope_begin(cmd, "mips");
        over_bricks(vct, cmd, vct->svo.mip, (struct vct_svo_push){ .depth = depth }, texels);
        gpu_scope_end(cmd);
        join(vct, cmd, depth);
    }
}
