// Debug views where light is kept in an octree.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_SVO 1
#include "vct_debug.glsl"
