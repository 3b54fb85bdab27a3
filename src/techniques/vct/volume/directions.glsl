// Ways along the axes for which the light volume has what is seen on them: six, or one volume for
// all.
#ifndef AG_VCT_WAYS_GLSL
#define AG_VCT_WAYS_GLSL

#include "techniques/vct/vct_constants.h"

layout(constant_id = VCT_CONSTANT_ANISOTROPIC) const bool VCT_ANISOTROPIC = true;
// Of occlusion (vctao) opacity alone is kept, in one channel where it is in mips.
layout(constant_id = VCT_CONSTANT_OCCLUSION) const bool VCT_OCCLUSION = false;
const int VCT_DIRECTIONS = VCT_ANISOTROPIC ? 6 : 1;

#endif
