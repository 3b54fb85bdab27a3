// Light that voxels get from each other, through the mips.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_SVO 0
#include "vct_bounce.glsl"
