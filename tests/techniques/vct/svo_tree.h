// The sparse voxel octree of a fixture, read back from the GPU: nodes, and bricks of light.
#pragma once

#include "techniques/vct/vct_fixture.h"

enum { SVO_MAX_DEPTHS = 8 };

struct svo_tree {
    struct vct_svo_params params;
    struct vct_svo_level levels[SVO_MAX_DEPTHS];
    uint32_t *nodes, *brick_coords;
    size_t node_count;
};

struct svo_tree svo_tree_of(const struct vct_fixture *fixture);
void svo_tree_finish(struct svo_tree *tree);
// The brick of a node, or -1.
int svo_tree_find(const struct svo_tree *tree, const int node[3], uint32_t depth);
// The coordinates of a brick's node.
void svo_tree_node_coord(const struct svo_tree *tree, int brick, int node[3]);

struct svo_pool {
    float *light; // to be freed
    struct gpu_image_desc desc;
    int row, directions;
};

struct svo_pool svo_pool_of(const struct vct_fixture *fixture);
// Radiance and opacity of one of 3 × 3 × 3 points.
const float *svo_pool_at(const struct svo_pool *pool, int brick, int direction, const int point[3]);

// A room inside of the grid with a point light and optionally a block.
void svo_fixture_room(struct vct_fixture *fixture, struct gpu *gpu, bool block);
