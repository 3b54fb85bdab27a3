// Transfer maps, cropped and packed into bins: Sunshine-Hill & Faloutsos 2006, sections 5.1 (the
// end) and 5.2. Many texels of a map are zero. Its other texels are covered by boxes, these are
// sliced into pieces of power-of-two widths, and the pieces fill bins without a gap.
//
// Shaders handle runs of ORT_RUN texels of a row. A piece begins at such a run, in its map and in
// its bin, and its width is a power of two from ORT_RUN to ORT_BIN_SIDE.
//
// Or pieces are tiles, a run wide, that follow each other in the order in which a gather reads
// them: workgroup after workgroup, then map after map. Memory is read in one stream, and fewer
// empty texels are kept.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "techniques/ort/ort_shared.h"

struct host;

enum { ORT_MAX_MAP_SIDE = 16384 };

// A rectangle of a map and its place in a bin. If the width of maps is no multiple of ORT_RUN, a
// piece may reach beyond the right edge by less than a run: these texels are zero.
struct ort_piece {
    uint32_t map;
    uint32_t x, y, width, height;
    uint32_t bin, bin_x, bin_y;
};

// occupied and packed, divided by bin_count · ORT_BIN_SIDE², are the occupancy of bins: by texels
// that are not zero, and by pieces.
struct ort_bins {
    struct host *host;
    struct ort_piece *pieces; // sorted by bin, bin_x, bin_y
    uint32_t piece_count;
    uint32_t bin_count; // packed / ORT_BIN_SIDE², rounded up
    uint64_t occupied;  // texels that are not zero, of all maps
    uint64_t packed;    // texels of all pieces
    uint32_t cuts;      // vertical splits made by the packing
};

// Fills mask[height][width] of a map: 1 where a texel is not zero, else 0. false: failed.
typedef bool ort_mask_function(void *user, uint32_t map, uint8_t *mask);

struct ort_bins_wish {
    uint32_t maps;
    uint32_t width, height; // of every map, 1…ORT_MAX_MAP_SIDE
    uint32_t tile_rows;     // of tiles, which divide ORT_BIN_SIDE; 0: pieces as in section 5.2
    ort_mask_function *mask;
    void *user;
};

// Asks for the mask of each map once, in order. Scratch memory is about two bytes a texel of one
// map, and some for each piece.
bool ort_bins_init(struct ort_bins *out, struct host *host, const struct ort_bins_wish *wish);
void ort_bins_finish(struct ort_bins *bins); // accepts zero
