// Push constants of direct.comp.
#ifndef AG_FRAME_DIRECT_SHARED_H
#define AG_FRAME_DIRECT_SHARED_H

#include "core/shared.h"

struct direct_push {
    float shadow_size;     // texels
    int32_t shadow_radius; // filter radius, texels
};

#endif
