// The cone of reflections of each pixel, through the octree.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_SVO 1
#include "vct_specular.glsl"
