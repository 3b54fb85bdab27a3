// The largest number of a 16-bit float: more becomes infinite in RGBA16F images and packed halves.
#ifndef CORE_HALF_GLSL
#define CORE_HALF_GLSL

const float HALF_MAX = 65504.0;

#endif
