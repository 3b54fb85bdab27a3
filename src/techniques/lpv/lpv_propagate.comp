// All steps but the last: in 32 bits, since rounding to 16 in every step loses more than 1e-4 of the flux.
#version 460
#define LPV_FORMAT rgba32f
#include "lpv_propagate.glsl"
