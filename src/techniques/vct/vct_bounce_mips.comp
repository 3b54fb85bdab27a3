// Light that voxels get from each other, through the mips.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "vct_bounce.glsl"
