// Strata of the blocks of a bake: a block's texels are one after another, and so are its sources,
// in the rows of its texels up to the first share of 0.
#pragma once

#include "core/host.h"

#include <stdint.h>

// Rows of a bake, checked: [texels] and [texels][sources].
struct radiosity_block_rows {
    const uint8_t *start;
    const uint32_t *source;
    const uint16_t *share;
    uint32_t texels;
    size_t sources;
};

// A source of a block: a node of the tree in the lower RADIOSITY_NODE_BITS, above it the stratum.
uint32_t radiosity_stratum_source(uint32_t node, uint32_t stratum);
uint32_t radiosity_source_node(uint32_t source);
uint32_t radiosity_source_stratum(uint32_t source);
// The end of the block that begins at a texel.
uint32_t radiosity_block_after(const struct radiosity_block_rows *rows, uint32_t first);

struct radiosity_strata {
    struct host *host;
    uint32_t count;
    uint32_t most;   // entries of a stratum
    uint32_t *first; // [count + 1] of its entries
    uint32_t *node;  // [entries]
    uint16_t *share; // [entries]
    uint32_t *of;    // [texels] the first stratum of its block
};
// Each block has at least one stratum. radiosity_strata_finish accepts zero.
bool radiosity_strata_init(struct radiosity_strata *out, struct host *host,
                           const struct radiosity_block_rows *rows);
void radiosity_strata_finish(struct radiosity_strata *strata);
