// Axis directions of the light volume: six volumes (anisotropic voxels), or an isotropic one.
#ifndef AG_VCT_DIRECTIONS_GLSL
#define AG_VCT_DIRECTIONS_GLSL

#include "techniques/vct/vct_constants.h"

layout(constant_id = VCT_CONSTANT_ANISOTROPIC) const bool VCT_ANISOTROPIC = true;
// vctao: opacity alone, in mips as one channel.
layout(constant_id = VCT_CONSTANT_OCCLUSION) const bool VCT_OCCLUSION = false;
const int VCT_DIRECTIONS = VCT_ANISOTROPIC ? 6 : 1;

#endif
