// Blocks: neighbouring texels that share the strata of their rows. A stratum's light is the mean of
// its sources, weighted by the rays of all texels of the block; a texel has a form factor of its
// own for each stratum. A block has as many sources as its texels have strata: nearly all that its
// rays meet, of which a row of one texel would choose a few, and mottle the light.
#pragma once

#include "scene/charts/squares.h"
#include "techniques/radiosity/bake/row.h"

enum {
    RADIOSITY_BLOCK_EDGE = 4, // texels; divides CHART_SQUARE
    RADIOSITY_BLOCK = RADIOSITY_BLOCK_EDGE * RADIOSITY_BLOCK_EDGE,
};

struct radiosity_block_hit {
    uint32_t cluster;
    struct radiosity_factor factor;
};

// Scratch memory of a task. radiosity_block_finish accepts zero.
struct radiosity_block_rays {
    struct host *host;
    struct radiosity_gather sum; // of the texels
    struct radiosity_block_hit *hits;
    size_t first_hit[RADIOSITY_BLOCK + 1];
    uint32_t texels;
    struct radiosity_share *shares; // [RADIOSITY_BLOCK · strata]
    uint32_t share_count;
    struct radiosity_factor *row; // [strata] of a texel
};
bool radiosity_block_init(struct radiosity_block_rays *block, struct host *host,
                          const struct radiosity_scene *scene);
void radiosity_block_finish(struct radiosity_block_rays *block);
size_t radiosity_block_bytes(uint64_t clusters, const struct radiosity_options *options);

// The texels first … of a block, of `most` that follow each other: of one side of a chart and one
// square of the atlas, and visible from the first one.
uint32_t radiosity_block_texels(const struct radiosity_scene *scene, uint32_t first, uint32_t most);

// Begins a block; adds what the rays of the next texel meet, NULL: it has none; finds the strata.
void radiosity_block_begin(struct radiosity_block_rays *block);
void radiosity_block_add(struct radiosity_block_rays *block, const struct radiosity_gather *texel);
void radiosity_block_end(struct radiosity_block_rays *block, struct radiosity_rows *rows,
                         uint32_t strata, float phase);
// The row of a texel: sums of each stratum. Valid until the next call.
const struct radiosity_factor *radiosity_block_row(struct radiosity_block_rays *block,
                                                   const struct radiosity_rows *rows,
                                                   uint32_t texel);
