// Random numbers as arguments: a generator is seeded from (pixel, sample, dimension), never from a clock.
// PCG32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
// Number Generation"), and the R2 low-discrepancy sequence (Roberts 2018). The GLSL twin is rng.glsl.
#pragma once

#include "core/vec.h"

#include <stdint.h>

struct rng {
    uint64_t state, increment;
};

struct rng rng_for(uint32_t pixel, uint32_t sample, uint32_t dimension);
uint32_t rng_u32(struct rng *rng);
float rng_float(struct rng *rng); // in [0, 1)
vec2s rng_vec2(struct rng *rng);
// PCG hash of one word (Jarzynski & Olano 2020), the same in GLSL.
uint32_t pcg_hash(uint32_t word);
// Point i of the R2 sequence, in [0, 1)².
vec2s r2_sequence(uint32_t i);
// Point i of the two-dimensional Sobol sequence, Owen-scrambled by `seed` (0: plain), in [0, 1)².
vec2s sobol_2d(uint32_t i, uint32_t seed);
