// Data that the shaders of the sparse voxel octree share with the host. Scalar layout.
#ifndef AG_VCT_OCTREE_SHARED_H
#define AG_VCT_OCTREE_SHARED_H

#include "techniques/vct/vct_shared.h"

#define VCT_SVO_BLOCK 32  // nodes that one invocation counts and divides
#define VCT_SVO_LOCAL 128 // invocations of a workgroup over bricks

// Uniform block "vct_svo".
struct vct_svo_params {
    uint32_t depths; // levels of nodes, root and leaves included
    uint32_t bricks; // capacity of the pool
    uint32_t tiles;  // capacity, of eight children each
    int32_t row;     // bricks along x and y of the pool
};

// Storage block "vct_svo_levels", one for each depth.
struct vct_svo_level {
    uint32_t first, count;    // bricks, which are numbered from the root down
    uint32_t overflow;        // marked nodes beyond the capacity
    uint32_t node_groups[3];  // of a dispatch over blocks of the children
    uint32_t texel_groups[3]; // over 32 invocations a brick
    uint32_t side_groups[3];  // over 16
};

struct vct_svo_push {
    uint32_t depth;
    uint32_t axis; // of the borders that are joined
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_svo_params) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_svo_level) == 12 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_svo_push) == 8, "layout is shared with GLSL");
#endif

#endif
