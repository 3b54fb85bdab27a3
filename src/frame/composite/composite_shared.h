// Specialization constants and parameters of composite.comp.
#ifndef AG_FRAME_COMPOSITE_SHARED_H
#define AG_FRAME_COMPOSITE_SHARED_H

#include "core/shared.h"

#define COMPOSITE_CONSTANT_IRRADIANCE 0 // inputs
#define COMPOSITE_CONSTANT_SPECULAR   1
#define COMPOSITE_CONSTANT_VISIBILITY 2
#define COMPOSITE_CONSTANT_INDIRECT   3 // outputs
#define COMPOSITE_CONSTANT_DISPLAY    4
#define COMPOSITE_CONSTANT_METER      5 // no image: fills the histogram of automatic exposure
#define COMPOSITE_CONSTANT_AGX        6 // tone curves of DISPLAY; neither: PBR Neutral
#define COMPOSITE_CONSTANT_LINEAR     7
#define COMPOSITE_CONSTANT_COUNT      8

struct composite_push {
    uint32_t stride; // between pixels; above 1 for METER only
};

#endif
