// Data that the shaders of the light volume share with the host. Scalar layout.
#ifndef AG_VCT_VOLUME_SHARED_H
#define AG_VCT_VOLUME_SHARED_H

#include "techniques/vct/vct_shared.h"

#define VCT_MAX_LEVELS  8  // mips of the light volume: enough for resolution=256
#define VCT_BLOCK_LOCAL 32 // blocks for which a workgroup gathers bounced light on one face
#define VCT_TEXELS_EACH 4  // texels whose voxels an invocation of volume/texels.comp reads

// Buffer "vct_texel_counts": occupied texels of each mip, and dispatches over them.
struct vct_texel_levels {
    uint32_t groups[3 * VCT_MAX_LEVELS]; // beyond mip 0: one invocation per axis direction
    uint32_t block_groups[3];            // of VCT_BLOCK_LOCAL blocks, for each face
    uint32_t count[VCT_MAX_LEVELS];
};

struct vct_texels_push {
    uint32_t levels;
    uint32_t directions;                 // volumes side by side
    uint32_t block_level;                // mip whose texels are the blocks of lighting/bounce.comp
    uint32_t first[VCT_MAX_LEVELS];      // of each mip in the buffer of lists
    uint32_t mask_first[VCT_MAX_LEVELS]; // its first bit
};

struct vct_mip_push {
    int32_t source_x, source_y, source_z; // texels of the source mip
    int32_t source_tile, target_tile;     // texels between axis directions
    uint32_t level;
    uint32_t first; // of the list of texels
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_texel_levels) == (4 * VCT_MAX_LEVELS + 3) * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_texels_push) == 12 + 2 * VCT_MAX_LEVELS * 4,
               "layout is shared with GLSL");
_Static_assert(sizeof(struct vct_mip_push) == 28, "layout is shared with GLSL");
#endif

#endif
