// Sizes, images and buffers of all volumes.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct lpv;
struct lpv_grid;
struct lpv_options;

// Slabs of a light volume: 12 or 27 coefficients, four to a texel.
uint32_t lpv_slabs(const struct lpv_options *options);
// Bytes of a cell in the buffers.
size_t lpv_sum_bytes(const struct lpv_options *options);
enum {
    LPV_SURFACE_BYTES = 6 * 4 * 4,
    LPV_SURFEL_BYTES = 4 * 4,
    LPV_COVERAGE_BYTES = 3 * 4,
};
size_t lpv_cell_count(const struct lpv_grid *grid); // in use

// All volumes of the finest cascade, or of the only grid.
bool lpv_volumes_create(struct lpv *lpv);
// A coarser cascade holds a copy of the finest's volumes: replaces those that each cascade owns.
bool lpv_volumes_create_coarser(struct lpv *lpv);
void lpv_volumes_destroy(struct lpv *lpv);
void lpv_volumes_destroy_coarser(struct lpv *lpv);
// GPU memory of all cascades.
uint64_t lpv_volumes_bytes(const struct lpv_options *options);
