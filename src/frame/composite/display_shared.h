// Specialization constants and parameters of display.comp.
#ifndef AG_FRAME_DISPLAY_SHARED_H
#define AG_FRAME_DISPLAY_SHARED_H

#include "core/shared.h"

#define DISPLAY_CONSTANT_AGX    0 // tone curves; neither: PBR Neutral
#define DISPLAY_CONSTANT_LINEAR 1
#define DISPLAY_CONSTANT_COUNT  2

// How a layer becomes linear display values.
#define DISPLAY_RADIANCE   0 // exposed and tone mapped
#define DISPLAY_IRRADIANCE 1 // likewise, E/π: of a white diffuse surface
#define DISPLAY_COLOR      2 // unchanged
#define DISPLAY_GREY       3 // the first channel
#define DISPLAY_NORMAL     4 // (n + 1)/2
#define DISPLAY_DEPTH      5 // 1/(1 + metres)
#define DISPLAY_MOTION     6 // x, y in pixels and z, each as (1 + v/(1 + |v|))/2

struct display_push {
    uint32_t kind;
};

#endif
