// The last step writes what the look-up filters: 16 bits, which every device can.
#version 460
#define LPV_FORMAT rgba16f
#include "lpv_propagate.glsl"
