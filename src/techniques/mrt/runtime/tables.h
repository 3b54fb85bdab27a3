// Tables of a level as the shaders read them (mrt_shared.h).
#pragma once

#include "techniques/mrt/runtime/runtime.h"

// Uploads texels, tiles, blocks, openings, pairs and borders into new buffers; fills
// runtime->level but for the lookup grid.
bool mrt_tables_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// Quads of an opening's coefficients.
uint32_t mrt_used_quads(const struct mrt_operators *operators, const struct mrt_opening *opening);
// A face of clutter that sends light to an opening.
struct mrt_sender {
    int block, slot;   // of the opening that is its clutter
    const float *of_c; // [k_r]
};
// Writes them to `out` unless that is NULL; returns their number. Those that send none are left
// out.
uint32_t mrt_senders(const struct mrt_opening *opening, struct mrt_sender *out);
// The senders of all openings, one after the other; the caller frees them.
struct mrt_sender *mrt_all_senders(struct host *host, const struct mrt_operators *operators,
                                   uint32_t *count);
// First texel of a block, those of its walls in ascending order; −1: no wall.
int mrt_first_texel(const struct mrt_atlas *atlas, int block);
enum { MRT_LOOKUP_CELLS = 32 }; // along the longest side of the level

// ---- lookup_grid.c: the blocks near each cell of a grid, for locate.glsl.
bool mrt_lookup_grid_upload(struct mrt_runtime *runtime, const struct mrt_block_map *map);
