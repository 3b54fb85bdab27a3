// Places of an atlas that are taken, and the lowest free one for a footprint.
#pragma once

#include "scene/charts/footprint.h"

enum { ATLAS_LEVELS = 8 };

struct atlas {
    struct host *host;
    uint32_t width, height; // places; height: of the room
    struct atlas_level {
        uint32_t columns, rows, words;       // words: of a row
        uint64_t *bits;                      // not 0 where a place of the square is taken
        uint32_t lowest[FOOTPRINT_SIDE + 1]; // row below which no square of this edge is free
    } level[ATLAS_LEVELS];
    uint64_t *blocked, *row, *any; // of one row of places
};

struct atlas_place {
    uint32_t x, y, turns, top;
};

bool atlas_init(struct atlas *out, struct host *host, uint32_t width, uint32_t height);
// Accepts zero.
void atlas_finish(struct atlas *atlas);
// Both have one size.
void atlas_copy(struct atlas *to, const struct atlas *from);
// Lowers *best to the place with the lowest top for a turn of the grid.
void atlas_find(struct atlas *atlas, const struct footprint_grid *grid, uint32_t turns,
                struct atlas_place *best);
void atlas_take(struct atlas *atlas, const struct footprint_grid *grid,
                const struct atlas_place *place);
