// Sizes, images and buffers of all volumes.
#pragma once

#include <stddef.h>
#include <stdint.h>

struct gpu_objects;
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

// All volumes, of all cascades.
void lpv_add_volumes(const struct lpv_options *options, struct gpu_objects *out);
