// The places of an atlas that a chart takes: texels that its surface touches, and its gutter.
#pragma once

#include "scene/charts/grow.h"

enum { FOOTPRINT_SIDE = 128, FOOTPRINT_WORDS = FOOTPRINT_SIDE / 64 };

// Bits of rows, one for each square of 2^level places.
struct footprint {
    uint32_t width, height; // at most FOOTPRINT_SIDE
    uint32_t count;         // of set bits
    uint32_t square;        // edge of the largest square of set bits
    uint32_t square_y;      // its first row
    uint64_t bits[FOOTPRINT_SIDE][FOOTPRINT_WORDS];
};

// Bytes of a chart's rectangle: not 0 where it takes the place.
struct footprint_grid {
    uint8_t *taken; // [width × height]
    uint32_t width, height;
};

// Rasterises a chart whose rectangle has the grid's size, and shrinks that to what is taken. spare:
// as large as grid->taken.
void footprint_draw(struct footprint_grid *grid, uint8_t *spare, const struct grown *grown,
                    const struct grown_chart *chart);
// The level at which a grid's footprint is not too large.
uint32_t footprint_level(const struct footprint_grid *grid);
// turns: quarters.
void footprint_make(struct footprint *out, const struct footprint_grid *grid, uint32_t turns,
                    uint32_t level);
// Whether the chart takes a place of its turned rectangle.
bool footprint_takes(const struct footprint_grid *grid, uint32_t turns, uint32_t x, uint32_t y);
