// A cache of operators of blocks, by hashes of their inputs: after a change of clutter only those
// of the blocks that it was in, or is in, are traced again.
#pragma once

#include "core/hash.h"

#include "techniques/mrt/clutter/clutter_transfer.h"
#include "techniques/mrt/clutter/delta_entry.h"
#include "techniques/mrt/clutter/delta_gather.h"

struct mrt_kept_block {
    bool has_delta, has_gathered, has_transfer;
    struct hash128 delta_key, gathered_key, transfer_key;
    struct mrt_delta_block delta;
    struct mrt_gather_faces gathered;
    struct mrt_clutter_transfer transfer;
};

struct mrt_kept_entry {
    bool valid;
    struct hash128 key;
    struct mrt_delta_entry entry;
};

struct mrt_delta_cache {
    struct host *host; // of the operators
    struct mrt_kept_block *blocks;
    struct mrt_kept_entry *entries; // [blocks][faces of the cube]
    int count;
    int traced; // blocks whose operators changed in the last update
};

// mrt_delta_cache_finish accepts zero.
bool mrt_delta_cache_init(struct mrt_delta_cache *out, struct host *host, int blocks);
void mrt_delta_cache_finish(struct mrt_delta_cache *cache);

// The operators of a block, kept or new; NULL: failed or stopped. Faces are numbered as the clutter
// of the input does.
const struct mrt_delta_block *mrt_kept_delta(struct mrt_delta_cache *cache,
                                             const struct mrt_delta_input *input);
const struct mrt_gather_faces *mrt_kept_gather(struct mrt_delta_cache *cache,
                                               const struct mrt_gather_input *input, int block);

const struct mrt_clutter_transfer *mrt_kept_transfer(struct mrt_delta_cache *cache,
                                                     const struct mrt_clutter_transfer_input *input,
                                                     int block);

const struct mrt_delta_entry *mrt_kept_entry(struct mrt_delta_cache *cache,
                                             const struct mrt_delta_entry_input *input);

// Bounds of the triangles of clutter that reach into a block.
struct box3 mrt_clutter_bounds_in(const struct mrt_clutter *clutter, const struct mrt_block *block);
