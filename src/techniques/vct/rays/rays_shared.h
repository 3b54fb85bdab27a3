// Data that the shaders of rays share with the host.
#ifndef AG_VCT_RAYS_SHARED_H
#define AG_VCT_RAYS_SHARED_H

#include "techniques/vct/vct_shared.h"

// A texel of the image "vct_blocks": words of the masks of the static and of the dynamic set, two
// each, a byte for each voxel: six faces, and whether all its surfaces lie along the axes. Without
// any face, a bit and the largest mip that is empty here too.
#define VCT_BLOCK_EMPTY 0x80000000u
#define VCT_EACH_VOXEL  0x01010101u

#endif
