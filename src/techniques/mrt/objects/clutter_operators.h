// Operators of blocks with clutter (objects/delta.h).
//
// Clutter changes the operators, not the passes. Blocks that it touches have bases U_b + ΔU_b and
// responses of their openings of their own. The faces of a block's clutter are one more opening of
// it, with the response ΔU_c. Its r is c, the radiosity of the faces: T_b→r carries light of b of
// all visible blocks, and the run time adds direct light and reflectance.
#pragma once

#include "techniques/mrt/objects/clutter.h"
#include "techniques/mrt/objects/delta_cache.h"
#include "techniques/mrt/level/operators.h"

struct mrt_clutter_changes {
    int rays, depth;         // rays per texel; openings that light on clutter passes at most
    bool occlusion;          // clutter blocks light
    bool reflection;         // it reflects light
    bool gather;             // it has a light map
    const atomic_bool *stop; // as of mrt_clutter_rays
};

// Numbers at most in the largest buffer of bases or responses, with those of the blocks in whose
// bounds there is clutter: operators are of a level without it. Writes the number of these blocks.
uint64_t mrt_clutter_numbers(const struct mrt_operators *operators, const struct mrt_block_map *map,
                             const struct mrt_clutter *clutter, int *blocks);
// Replaces operators of a level, block after block. texels: those of clutter->texels, in their
// order. The cache must outlive the call only.
bool mrt_operators_add_clutter(struct mrt_operators *operators, const struct mrt_level *level,
                               const struct mrt_clutter *clutter,
                               const struct mrt_geometry_texel *texels,
                               struct mrt_delta_cache *cache,
                               const struct mrt_clutter_changes *changes);

// ---- face_order.c

// Orders the coefficients of faces so that few are zero. Faces that send light to clutter of their
// block come first, then those that send some to walls or openings; others lose their coefficient,
// as their c lights nothing: no ray from a texel, a probe or a face meets the underside of a box on
// a floor.
bool mrt_order_faces(struct mrt_operators *operators);
