#include "techniques/svo_tree.h"

#include <stdlib.h>

struct svo_tree svo_tree_of(const struct vct_rig *rig)
{
    const struct vct_svo *svo = &rig->vct->svo;
    struct gpu *gpu = rig->frame_fixture.gpu;
    const size_t node_bytes = gpu_buffer_bytes(gpu, svo->nodes),
                 place_bytes = gpu_buffer_bytes(gpu, svo->brick_coords);
    struct svo_tree tree = { .params = svo->params,
                             .nodes = malloc(node_bytes),
                             .places = malloc(place_bytes),
                             .node_count = node_bytes / sizeof(uint32_t) };
    CHECK(tree.params.depths <= SVO_MOST_DEPTHS);
    CHECK(gpu_buffer_download(gpu, svo->nodes, 0, tree.nodes, node_bytes));
    CHECK(gpu_buffer_download(gpu, svo->brick_coords, 0, tree.places, place_bytes));
    CHECK(gpu_buffer_download(gpu, svo->levels, 0, tree.levels,
                              tree.params.depths * sizeof *tree.levels));
    return tree;
}

void svo_tree_finish(struct svo_tree *tree)
{
    free(tree->nodes);
    free(tree->places);
}

int svo_tree_find(const struct svo_tree *tree, const int node[3], uint32_t depth)
{
    uint32_t at = 0;
    for (uint32_t left = depth; left > 0; left--) {
        if (tree->nodes[at] == 0) return -1;
        at = 8 * tree->nodes[at];
        for (int a = 0; a < 3; a++) at += (uint32_t)(node[a] >> (left - 1) & 1) << a;
        CHECK(at < tree->node_count);
    }
    return (int)tree->nodes[at] - 1;
}

void svo_tree_place(const struct svo_tree *tree, int brick, int node[3])
{
    for (int a = 0; a < 3; a++) node[a] = (int)(tree->places[brick] >> (10 * a) & 1023u);
}

struct svo_pool svo_pool_of(const struct vct_rig *rig)
{
    struct svo_pool pool = { .desc = vct_svo_pool(&rig->vct->options),
                             .row = rig->vct->svo.params.row,
                             .directions = (int)vct_direction_count(&rig->vct->options) };
    const size_t floats =
        4 * (size_t)pool.desc.width * (size_t)pool.desc.height * (size_t)pool.desc.depth;
    pool.light = malloc(floats * sizeof *pool.light);
    CHECK(gpu_image_download_float(rig->frame_fixture.gpu, rig->vct->light, 0, 0, pool.light, 4,
                                   floats));
    return pool;
}

const float *svo_pool_at(const struct svo_pool *pool, int brick, int way, const int point[3])
{
    const int r = pool->row, x = 3 * (brick % r + way * r) + point[0],
              y = 3 * (brick / r % r) + point[1], z = 3 * (brick / (r * r)) + point[2];
    return pool->light +
           4 * (((size_t)z * pool->desc.height + (size_t)y) * pool->desc.width + (size_t)x);
}

void svo_furnish(struct vct_rig *rig, struct gpu *gpu, bool block)
{
    vct_rig_init(rig, gpu);
    struct frame_fixture *s = &rig->frame_fixture;
    fixture_box(s, vec3_of(0.3f, 0.2f, 0.4f), vec3_of(11.2f, 9.1f, 10.7f), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    if (block)
        fixture_box(s, vec3_of(6, 0.2f, 3), vec3_of(8, 4, 6), false,
                    fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    fixture_look(s, vec3_of(1, 6, 9), vec3_of(8, 2, 3));
}
