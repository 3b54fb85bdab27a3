// Specialization constants and parameters of antialias.comp.
#ifndef AG_FRAME_ANTIALIAS_SHARED_H
#define AG_FRAME_ANTIALIAS_SHARED_H

#include "core/shared.h"

#define ANTIALIAS_CONSTANT_MOVES   0 // reprojects and clips the history
#define ANTIALIAS_CONSTANT_DISPLAY 1 // output
#define ANTIALIAS_CONSTANT_AGX     2 // tone curves of DISPLAY; neither: PBR Neutral
#define ANTIALIAS_CONSTANT_LINEAR  3
#define ANTIALIAS_CONSTANT_COUNT   4

#define ANTIALIAS_SAMPLES 64 // most of a mean, and points of the jitter; below 128

struct antialias_push {
    uint32_t most; // weight of the history in samples, at most; 0: there is none
};

#endif
