// Operators of the light map of clutter (clutter/clutter_transfer.h), and the map's atlas.
#pragma once

#include "techniques/mrt/clutter/delta_cache.h"
#include "techniques/mrt/runtime/turned.h"

struct mrt_mapped {
    struct host *host;
    struct mrt_clutter_rows_input *rows; // of each block with clutter
    bool *inside;                        // of each texel of the clutter, in its order
    uint32_t *source;
    struct mrt_clutter_atlas_input input;
};

// Room for `blocks`. mrt_mapped_finish accepts zero.
bool mrt_mapped_init(struct mrt_mapped *out, struct host *host, int blocks);
// Light at the clutter of a block with faces. openings: those of the block in the run time's input.
bool mrt_mapped_add(struct mrt_mapped *out, const struct mrt_turned *turned,
                    struct mrt_delta_cache *cache, const struct mrt_clutter_transfer_input *input,
                    int block, const struct mrt_opening_input *openings, int opening_count);
// After all blocks: sources of the atlas. Texels inside objects have that of the nearest other one
// of their chart.
bool mrt_mapped_place(struct mrt_mapped *out, const struct mrt_clutter *clutter);
void mrt_mapped_finish(struct mrt_mapped *mapped);
