#include "techniques/vct/svo_tree.h"

#include <stdlib.h>

struct svo_tree svo_tree_of(const struct vct_fixture *fixture)
{
    const struct vct_svo *svo = &fixture->vct->svo;
    struct gpu *gpu = fixture->frame_fixture.gpu;
    const size_t node_bytes = gpu_buffer_bytes(gpu, svo->nodes),
                 coord_bytes = gpu_buffer_bytes(gpu, svo->brick_coords);
    struct svo_tree tree = { .params = svo->params,
                             .nodes = malloc(node_bytes),
                             .brick_coords = malloc(coord_bytes),
                             .node_count = node_bytes / sizeof(uint32_t) };
    CHECK(tree.params.depths <= SVO_MAX_DEPTHS);
    CHECK(gpu_buffer_download(gpu, svo->nodes, 0, tree.nodes, node_bytes));
    CHECK(gpu_buffer_download(gpu, svo->brick_coords, 0, tree.brick_coords, coord_bytes));
    CHECK(gpu_buffer_download(gpu, svo->levels, 0, tree.levels,
                              tree.params.depths * sizeof *tree.levels));
    return tree;
}

void svo_tree_finish(struct svo_tree *tree)
{
    free(tree->nodes);
    free(tree->brick_coords);
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

void svo_tree_node_coord(const struct svo_tree *tree, int brick, int node[3])
{
    for (int a = 0; a < 3; a++) node[a] = (int)(tree->brick_coords[brick] >> (10 * a) & 1023u);
}

struct svo_pool svo_pool_of(const struct vct_fixture *fixture)
{
    struct svo_pool pool = { .desc = vct_svo_pool(&fixture->vct->options),
                             .row = fixture->vct->svo.params.row,
                             .directions = (int)vct_direction_count(&fixture->vct->options) };
    const size_t floats =
        4 * (size_t)pool.desc.width * (size_t)pool.desc.height * (size_t)pool.desc.depth;
    pool.light = malloc(floats * sizeof *pool.light);
    CHECK(gpu_image_download_float(fixture->frame_fixture.gpu, fixture->vct->volume.light, 0, 0,
                                   pool.light, 4, floats));
    return pool;
}

const float *svo_pool_at(const struct svo_pool *pool, int brick, int direction, const int point[3])
{
    const int r = pool->row, x = 3 * (brick % r + direction * r) + point[0],
              y = 3 * (brick / r % r) + point[1], z = 3 * (brick / (r * r)) + point[2];
    return pool->light +
           4 * (((size_t)z * pool->desc.height + (size_t)y) * pool->desc.width + (size_t)x);
}

void svo_fixture_room(struct vct_fixture *fixture, struct gpu *gpu, bool block)
{
    vct_fixture_init(fixture, gpu);
    struct frame_fixture *s = &fixture->frame_fixture;
    fixture_box(s, vec3_of(0.3f, 0.2f, 0.4f), vec3_of(11.2f, 9.1f, 10.7f), true,
                fixture_matte(s, vec3_of(0.7f, 0.5f, 0.3f)));
    if (block)
        fixture_box(s, vec3_of(6, 0.2f, 3), vec3_of(8, 4, 6), false,
                    fixture_matte(s, vec3_of(0.2f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(3, 7, 5), vec3_of(300, 500, 200));
    fixture_look(s, vec3_of(1, 6, 9), vec3_of(8, 2, 3));
}
