// Tiles of large triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_LARGE 1
#include "vct_add.glsl"
