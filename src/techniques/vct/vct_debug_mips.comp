// Debug views where light is kept in mips.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_SVO 0
#include "vct_debug.glsl"
