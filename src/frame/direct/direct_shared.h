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
#define DIRECT_CONSTANT_BLOCKS     5 // one sun whose maps have blocks
#define DIRECT_CONSTANT_EMISSION   6 // there are emissive or unlit surfaces
#define DIRECT_CONSTANT_MAP        7 // the environment has a map
#define DIRECT_CONSTANT_BITS       8
#define DIRECT_CONSTANT_CASCADES   8 // per sun

struct direct_push {
    int32_t shadow_radius; // filter radius, texels
};

#define DIRECT_LIST_GROUP 64 // pixels per group of direct_undecided.comp

// Storage block "direct_list": the pixels that direct_undecided.comp tests.
struct direct_list_header {
    uint32_t count;
    uint32_t groups[3]; // of the dispatch
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct direct_list_header) == 16, "layout is shared with GLSL");
#endif

#endif
