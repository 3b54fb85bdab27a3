// Masks of transfer maps for tests of their bins.
#pragma once

#include "techniques/ort/bins.h"

enum map_kind {
    MAP_EMPTY,
    MAP_FULL,
    MAP_DOTS,    // about one texel of 50
    MAP_DISCS,   // five
    MAP_STRIPES, // rows of one map, columns of the next
    MAP_RING,
    MAP_ISLANDS, // of an atlas, and the same islands shifted by the map's offset: where both are
    MAP_KINDS
};

struct test_maps {
    enum map_kind kind;
    uint32_t width, height, seed;
    uint32_t rows;  // of full maps that are not zero; 0: all
    uint32_t fails; // 1 + the map whose mask fails; 0: none
    uint8_t *atlas; // [height][width] of MAP_ISLANDS
};

// Makes the atlas: boxes and ellipses that cover about 65 % where there is room.
struct test_maps test_maps_of(enum map_kind kind, uint32_t width, uint32_t height, uint32_t seed);
void test_maps_finish(struct test_maps *maps);
// An ort_mask_function; user: struct test_maps.
bool test_maps_mask(void *user, uint32_t map, uint8_t *mask);
