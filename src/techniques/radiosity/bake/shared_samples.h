// Low-discrepancy samples that neighbouring texels of a chart share: each texel has a part of them,
// so that the mean over neighbours converges as one texel with all their samples would.
#pragma once

#include "core/rng.h"
#include "scene/charts/charts.h"

// Texels along an edge of the square that shares one Sobol sequence.
enum { RADIOSITY_SHARED_BITS = 3 };

// The part of the sequence of a place in the atlas, in Morton order: that of an aligned square of
// 2 × 2 or 4 × 4 texels is a (0, 2)-net if the number of rays is a power of two.
static inline uint32_t radiosity_shared_part(uint32_t x, uint32_t y)
{
    uint32_t part = 0;
    for (uint32_t b = 0; b < RADIOSITY_SHARED_BITS; b++)
        part |= (x >> b & 1) << 2 * b | (y >> b & 1) << (2 * b + 1);
    return part;
}

// One for each side of a chart.
static inline uint32_t radiosity_shared_seed(const struct charts *charts, uint32_t texel)
{
    return 2 * chart_triangle_of(charts, texel)->chart + (chart_is_back(charts, texel) ? 1 : 0);
}

// Phases of rows, 0…1: a rank-1 lattice over places of the atlas by the numbers of the R2 sequence
// (Roberts 2018), which is even over squares and over lines of texels.
static inline float radiosity_shared_phase(uint32_t x, uint32_t y)
{
    static const uint32_t inverse_g = 3242174889u, inverse_g2 = 2447445414u;
    return rng_unit(x * inverse_g + y * inverse_g2);
}
