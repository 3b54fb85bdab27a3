// Constants of direct.comp.
#ifndef AG_FRAME_DIRECT_SHARED_H
#define AG_FRAME_DIRECT_SHARED_H

#include "core/shared.h"

#define DIRECT_CONSTANT_HAS_LIGHTS 0 // specialization constant

struct direct_push {
    float shadow_size;     // texels
    int32_t shadow_radius; // filter radius, texels
};

#endif
