// Constants of direct.comp.
#ifndef AG_FRAME_DIRECT_SHARED_H
#define AG_FRAME_DIRECT_SHARED_H

#include "core/shared.h"

// Specialization constants.
#define DIRECT_CONSTANT_HAS_LIGHTS 0
#define DIRECT_CONSTANT_DIELECTRIC 1

struct direct_push {
    float shadow_size;     // texels
    int32_t shadow_radius; // filter radius, texels
};

#endif
