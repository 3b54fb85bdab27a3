// Small triangles, and tiles of large ones into the queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VCT_LARGE 0
#include "vct_add.glsl"
