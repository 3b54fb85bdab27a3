// Operators of a level with clutter (clutter/delta.h), as input of the run time.
//
// Clutter changes the operators, not the passes. Blocks that it touches have bases U_b + ΔU_b and
// responses of their openings of their own. The faces of a block's clutter are one more opening of
// it, with the response ΔU_c. Its r is c, the radiosity of the faces: T_b→r carries light of b of
// all visible blocks, and clutter.c adds direct light and reflectance.
#pragma once

#include "techniques/mrt/clutter/delta_cache.h"
#include "techniques/mrt/runtime/clutter/clutter_atlas.h"
#include "techniques/mrt/runtime/level_operators.h"

struct mrt_delta_options {
    int rays, depth;         // rays per texel; openings that light on clutter passes at most
    bool occlusion;          // clutter blocks light
    bool reflection;         // it reflects light
    bool gather;             // it has a light map
    const atomic_bool *stop; // as of mrt_delta_input
};

struct mrt_delta_operators {
    struct host *host;
    struct mrt_response_input *responses;
    int shared_responses; // the first ones, of `operators`
    struct mrt_opening_input *openings;
    struct mrt_pair_input *pairs;
    struct matrix_f32 *gathered; // T_b→r of faces
    int gathered_count;
    struct mrt_clutter_face_input *faces;
    int *clutter_openings;
    struct mrt_face_pair_input *face_pairs;
    int face_pair_count;
    uint32_t *sight; // mrt_runtime_input.sight
    struct mrt_clutter_atlas atlas;
    struct mrt_clutter_input clutter;
    struct mrt_runtime_input input; // refers to `operators`
};

// Adds bases to `operators`, which must outlive the input. texels: those of clutter->texels, in
// their order. The cache must outlive the call only. mrt_delta_operators_finish accepts zero.
bool mrt_delta_operators_init(struct mrt_delta_operators *out, struct host *host,
                              struct mrt_level_operators *operators, const struct mrt_level *level,
                              const struct mrt_clutter *clutter,
                              const struct mrt_clutter_texel *texels, struct mrt_delta_cache *cache,
                              const struct mrt_delta_options *options);
void mrt_delta_operators_finish(struct mrt_delta_operators *operators);
