// Sizes and pushes of low-rank transfer, which the host and the shaders share. Scalar layout.
#ifndef AG_RADIOSITY_LOWRANK_SHARED_H
#define AG_RADIOSITY_LOWRANK_SHARED_H

#include "core/shared.h"

// Texels of a region, a multiple of RADIOSITY_LOCAL.
#define RADIOSITY_REGION 256

// Modes that a texel of a table has, of one component; modes of a region are a multiple of it.
#define RADIOSITY_MODES 8

// Sources that a workgroup of a projection reads at once: its size.
#define RADIOSITY_PROJECT_LOCAL 8

// Of a region in the table of regions: first texel in the table of projections, first source, first
// mode; RADIOSITY_MODES-tuples of modes in the lower half, RADIOSITY_PROJECT_LOCAL-tuples of
// sources in the upper half. Expansions have three components, for each row of each region.
#define RADIOSITY_REGION_SHIFT 16

struct radiosity_project_push {
    uint32_t first; // region
};

struct radiosity_expand_push {
    uint32_t first, count; // rows
    uint32_t texels;
    float emitters; // 1: emissive surfaces are sources, 0: they are not
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct radiosity_project_push) == 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_expand_push) == 16, "layout is shared with GLSL");
#endif

#endif
