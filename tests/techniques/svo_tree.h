// The sparse voxel octree of a rig as it is on the GPU: nodes, and bricks of light.
#pragma once

#include "techniques/vct_rig.h"

enum { SVO_MOST_DEPTHS = 8 };

struct svo_tree {
    struct vct_svo_params params;
    struct vct_svo_level levels[SVO_MOST_DEPTHS];
    uint32_t *nodes, *places;
    size_t node_count;
};

struct svo_tree svo_tree_of(const struct vct_rig *rig);
void svo_tree_finish(struct svo_tree *tree);
// The brick of a node, or -1.
int svo_tree_find(const struct svo_tree *tree, const int node[3], uint32_t depth);
// The node of a brick.
void svo_tree_place(const struct svo_tree *tree, int brick, int node[3]);

struct svo_pool {
    float *light; // to be freed
    struct gpu_image_desc desc;
    int row, directions;
};

struct svo_pool svo_pool_of(const struct vct_rig *rig);
// Radiance and opacity at one of 3 x 3 x 3 points.
const float *svo_pool_at(const struct svo_pool *pool, int brick, int way, const int point[3]);

// A room whose walls stand away from the border of the grid, a light, and a block if asked for.
void svo_furnish(struct vct_rig *rig, struct gpu *gpu, bool block);
