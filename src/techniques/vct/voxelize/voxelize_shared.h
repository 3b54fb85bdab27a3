// Data that the shaders of voxelization share with the host. Scalar layout.
#ifndef AG_VCT_VOXELIZE_SHARED_H
#define AG_VCT_VOXELIZE_SHARED_H

#include "techniques/vct/vct_shared.h"

#define VCT_TILE          32    // columns along a side of a large triangle's tile; bits of a word
#define VCT_SMALL_COLUMNS 64    // most columns of a triangle that one invocation traverses
#define VCT_QUEUE         65535 // tiles of large triangles
#define VCT_BLOCK_WORDS   32    // words of the mask that one invocation counts and lists

// Words of vct_sum_words for a face of a voxel: see voxelize/surface.glsl.
#define VCT_SUM_WEIGHT      0
#define VCT_SUM_OPACITY     1
#define VCT_SUM_REFLECTANCE 2  // 3 words, × opacity
#define VCT_SUM_NORMAL      5  // 3 words, signed
#define VCT_SUM_POSITION    8  // 3 words, signed, from the voxel's centre
#define VCT_SUM_EMISSION    11 // 3 words, × opacity; negative for small emitters
#define VCT_SUM_COVERED     14 // covered weight
#define VCT_SUM_OUTERMOST   15 // 4 words, heights: voxelize/lines.glsl
#define VCT_SUM_LINES       19 // bits: the lines that cross it visibly
#define VCT_SUM_WORDS       20

// Coverage is the number of sample lines through a voxel that a triangle crosses.
#define VCT_LINES        16
#define VCT_WEIGHT_LINE  64.0
#define VCT_WEIGHT_ONE   1024.0 // weight of a whole voxel face: all lines
#define VCT_COLOUR_ONE   255.0
#define VCT_NORMAL_ONE   127.0
#define VCT_POSITION_ONE 127.0 // of a whole voxel
#define VCT_EMISSION_ONE 256.0 // of the strongest emission of the scene

// Buffer "vct_arguments" of a voxel set.
struct vct_voxel_counts {
    uint32_t groups[3]; // of a dispatch over all occupied faces
    uint32_t listed;
    uint32_t overflow;              // occupied faces beyond the capacity
    uint32_t accumulated_groups[3]; // of a dispatch over faces whose triangles are summed up
    uint32_t accumulated;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_voxel_counts) == 9 * 4, "layout is shared with GLSL");
#endif

#endif
