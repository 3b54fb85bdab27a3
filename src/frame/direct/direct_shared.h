// Constants of direct.comp.
#ifndef AG_FRAME_DIRECT_SHARED_H
#define AG_FRAME_DIRECT_SHARED_H

#include "core/shared.h"

// Specialization constants.
#define DIRECT_CONSTANT_SUNS       0 // there are suns
#define DIRECT_CONSTANT_LOCALS     1 // there are points or spots
#define DIRECT_CONSTANT_ONE_SUN    2 // the sun is the only light
#define DIRECT_CONSTANT_DIELECTRIC 3
#define DIRECT_CONSTANT_FILTERED   4 // shadow_radius > 0
#define DIRECT_CONSTANT_BITS       5
#define DIRECT_CONSTANT_CASCADES   5 // per sun

struct direct_push {
    int32_t shadow_radius; // filter radius, texels
};

#endif
