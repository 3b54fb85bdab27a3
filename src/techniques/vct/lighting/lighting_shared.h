// Data that the shaders of bounced light share with the host. Scalar layout.
#ifndef AG_VCT_LIGHTING_SHARED_H
#define AG_VCT_LIGHTING_SHARED_H

#include "core/shared.h"

// Parts of static voxels that gather in each frame while light changes, approximately: blocks take
// turns.
#define VCT_PARTS_OF_TURN 1024
#define VCT_PARTS_EACH    8 // that an invocation examines then

// Buffer "vct_part_counts" of a voxel set.
struct vct_part_count {
    uint32_t groups[3];      // of a dispatch over all parts
    uint32_t turn_groups[3]; // with VCT_PARTS_EACH parts for each invocation
    uint32_t count;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_part_count) == 7 * 4, "layout is shared with GLSL");
#endif

#endif
