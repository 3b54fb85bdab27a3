// Ways along the axes for which the light volume has what is seen on them: six, or one volume for
// all.
#ifndef AG_VCT_WAYS_GLSL
#define AG_VCT_WAYS_GLSL

layout(constant_id = 10) const bool VCT_ANISOTROPIC = true;
// Of occlusion (vctao) opacity alone is kept, in one channel where it is in mips.
layout(constant_id = 12) const bool VCT_OCCLUSION = false;
const int VCT_WAYS = VCT_ANISOTROPIC ? 6 : 1;

#endif
