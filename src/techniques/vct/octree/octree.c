// The sparse voxel octree: nodes from the list of voxels, level by level from the root; their
// bricks of light from the leaves up (Hong 2015, sec. 2.5.3.2 and 2.5.3.3.3).
#include "techniques/vct/vct_state.h"

// ---- Sizes --------------------------------------------------------------------------------------

bool vct_has_svo(const struct vct_options *options)
{
    return options->storage == VCT_SVO;
}

// Leaves along a side: four voxels each, and a power of two of them.
static uint32_t leaf_dim(const struct vct_options *options)
{
    uint32_t dim = 1;
    while (4 * dim < (uint32_t)options->resolution) dim *= 2;
    return dim;
}

// Bricks for 14 squares of leaves as the grid's faces are, all levels together, or for all nodes
// that there can be. Rooms and courts of 64 to 256 voxels take 4 to 9 squares.
struct vct_svo_params vct_svo_params(const struct vct_options *options)
{
    const uint32_t dim = leaf_dim(options), inner = (dim * dim * dim - 1) / 7;
    const uint32_t all = inner + dim * dim * dim, most = 14 * dim * dim;
    struct vct_svo_params params = { .bricks = most < all ? most : all, .row = 1 };
    params.tiles = inner < params.bricks ? inner : params.bricks;
    for (uint32_t d = dim; d > 0; d /= 2) params.depths++;
    while ((uint32_t)(params.row * params.row * params.row) < params.bricks) params.row *= 2;
    return params;
}

// The root's tile, of which it alone is in use, and those of children.
size_t vct_svo_nodes(const struct vct_options *options)
{
    return 8 * ((size_t)vct_svo_params(options).tiles + 1);
}

struct gpu_image_desc vct_svo_pool(const struct vct_options *options)
{
    const struct vct_svo_params params = vct_svo_params(options);
    const uint32_t row = (uint32_t)params.row;
    return (struct gpu_image_desc){ .name = "bricks",
                                    .dimension = GPU_3D,
                                    .format = GPU_RGBA16F,
                                    .width = 3 * vct_ways(options) * row,
                                    .height = 3 * row,
                                    .depth = 3 * gpu_groups(params.bricks, row * row),
                                    .mips = 1,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

// ---- The tree -----------------------------------------------------------------------------------

struct gpu_binding vct_svo_binding(struct vct *vct, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "vct_svo", &vct->svo.params, sizeof vct->svo.params);
}

static size_t level_offset(uint32_t depth, size_t member)
{
    return depth * sizeof(struct vct_svo_level) + member;
}

static void mark(struct vct *vct, struct gpu_cmd *cmd, const struct vct_set *set, uint32_t depth)
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

// A pass over the nodes at a depth, in blocks; how many there are says the level above.
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

static void divide(struct vct *vct, struct gpu_cmd *cmd, uint32_t depth)
{
    const struct vct_svo *svo = &vct->svo;
    const struct vct_svo_push push = { .depth = depth };
    const struct gpu_binding bindings[] = { vct_grid_binding(vct, &vct->clips[0], cmd),
                                            vct_svo_binding(vct, cmd),
                                            { .name = "vct_svo_nodes", .buffer = svo->nodes },
                                            { .name = "vct_svo_blocks", .buffer = svo->blocks },
                                            { .name = "vct_svo_places", .buffer = svo->places },
                                            { .name = "vct_svo_levels", .buffer = svo->levels } };
    const int count = sizeof bindings / sizeof bindings[0];
    over_nodes(cmd, svo, svo->count, bindings, count, depth);
    gpu_dispatch(cmd, svo->scan, bindings, count, &push, sizeof push, 1, 1, 1);
    over_nodes(cmd, svo, svo->divide, bindings, count, depth);
}

void vct_svo_record_tree(struct vct *vct, struct gpu_cmd *cmd)
{
    vct_pass_begin(vct->name, cmd, "nodes");
    gpu_fill_buffer(cmd, vct->svo.nodes, 0, 8 * sizeof(uint32_t), 0); // an empty root
    for (uint32_t depth = 0; depth < vct->svo.params.depths; depth++) {
        mark(vct, cmd, &vct->clips[0].rest, depth);
        if (vct->moving_draws > 0) mark(vct, cmd, &vct->clips[0].moving, depth);
        divide(vct, cmd, depth);
    }
    gpu_scope_end(cmd);
}

// ---- Light in the bricks ------------------------------------------------------------------------

static void over_bricks(struct vct *vct, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                        struct vct_svo_push push, size_t groups)
{
    gpu_dispatch_indirect(cmd, pipeline,
                          GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd),
                                   vct_svo_binding(vct, cmd), VCT_BOTH_SETS(&vct->clips[0]),
                                   { .name = "light", .image = vct->light },
                                   { .name = "vct_svo_nodes", .buffer = vct->svo.nodes },
                                   { .name = "vct_svo_places", .buffer = vct->svo.places },
                                   { .name = "vct_svo_levels", .buffer = vct->svo.levels }),
                          &push, sizeof push, vct->svo.levels, level_offset(push.depth, groups));
}

static void join(struct vct *vct, struct gpu_cmd *cmd, uint32_t depth)
{
    vct_pass_begin(vct->name, cmd, "borders");
    for (uint32_t axis = 0; axis < 3; axis++)
        over_bricks(vct, cmd, vct->svo.join, (struct vct_svo_push){ .depth = depth, .axis = axis },
                    offsetof(struct vct_svo_level, side_groups));
    gpu_scope_end(cmd);
}

void vct_svo_record_light(struct vct *vct, struct gpu_cmd *cmd)
{
    const uint32_t leaves = vct->svo.params.depths - 1;
    vct->clips[0].lit = vct->clips[0].grid;
    const size_t texels = offsetof(struct vct_svo_level, texel_groups);
    vct_pass_begin(vct->name, cmd, "leaves");
    over_bricks(vct, cmd, vct->svo.fill[vct->moving_draws > 0],
                (struct vct_svo_push){ .depth = leaves }, texels);
    gpu_scope_end(cmd);
    join(vct, cmd, leaves);
    for (uint32_t depth = leaves; depth-- > 0;) {
        vct_pass_begin(vct->name, cmd, "mips");
        over_bricks(vct, cmd, vct->svo.mip, (struct vct_svo_push){ .depth = depth }, texels);
        gpu_scope_end(cmd);
        join(vct, cmd, depth);
    }
}
