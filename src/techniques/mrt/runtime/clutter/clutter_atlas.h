// Atlas of the light map of clutter, and the transfer to its texels (clutter/clutter_transfer.h).
#pragma once

#include "techniques/mrt/clutter/delta_cache.h"
#include "techniques/mrt/runtime/level_operators.h"

struct mrt_clutter_atlas {
    struct host *host;
    struct mrt_clutter_rows_input *rows; // of each block with clutter
    bool *inside;                        // of each texel of the clutter, in its order
    uint32_t *source;
    struct mrt_clutter_atlas_input input;
};

// Room for `blocks`. mrt_clutter_atlas_finish accepts zero.
bool mrt_clutter_atlas_init(struct mrt_clutter_atlas *out, struct host *host, int blocks);
// Light at the clutter of a block with faces. openings: those of the block in the run time's input.
bool mrt_clutter_atlas_add(struct mrt_clutter_atlas *out,
                           const struct mrt_level_operators *operators,
                           struct mrt_delta_cache *cache,
                           const struct mrt_clutter_transfer_input *input, int block,
                           const struct mrt_opening_input *openings, int opening_count);
// After all blocks: sources of the atlas. Texels inside objects have that of the nearest other one
// of their chart.
bool mrt_clutter_atlas_place(struct mrt_clutter_atlas *out, const struct mrt_clutter *clutter);
void mrt_clutter_atlas_finish(struct mrt_clutter_atlas *atlas);
