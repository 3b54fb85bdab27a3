// A cache of operators of blocks, by hashes of their inputs: after a change of clutter only those
// of the blocks that it was in, or is in, are traced again.
#pragma once

#include "core/hash.h"

#include "techniques/mrt/objects/delta.h"

struct mrt_kept {
    bool valid;
    struct hash128 key;
};

struct mrt_kept_block {
    struct mrt_kept of_delta, of_gathered, of_transfer;
    struct mrt_delta_block delta;
    struct mrt_gather_faces gathered;
    struct mrt_clutter_transfer transfer;
};

struct mrt_kept_entry {
    struct mrt_kept kept;
    struct mrt_delta_entry entry;
};

struct mrt_delta_cache {
    struct host *host; // of the operators
    struct mrt_kept_block *blocks;
    struct mrt_kept_entry *entries; // [blocks][faces of the cube]
    struct hash128 *contents;       // [blocks]: of the clutter in each of them
    struct hash128 everything;      // of all clutter
    int count;
    int traced; // blocks whose operators changed in the last update
};

// mrt_delta_cache_finish accepts zero.
bool mrt_delta_cache_init(struct mrt_delta_cache *out, struct host *host, int blocks);
void mrt_delta_cache_finish(struct mrt_delta_cache *cache);
// Before the operators of an update, which have the same rays.
void mrt_delta_cache_begin(struct mrt_delta_cache *cache, const struct mrt_clutter_rays *rays);

// The operators of a block or an opening, kept or new; NULL: failed or stopped. Faces are numbered
// as the clutter of the rays does.
const struct mrt_delta_block *mrt_kept_delta(struct mrt_delta_cache *cache,
                                             const struct mrt_clutter_rays *rays, int block);
const struct mrt_gather_faces *mrt_kept_gather(struct mrt_delta_cache *cache,
                                               const struct mrt_clutter_rays *rays, int block);
const struct mrt_clutter_transfer *
mrt_kept_transfer(struct mrt_delta_cache *cache, const struct mrt_clutter_rays *rays, int block);
const struct mrt_delta_entry *mrt_kept_entry(struct mrt_delta_cache *cache,
                                             const struct mrt_clutter_rays *rays,
                                             const struct mrt_entered_opening *opening);
