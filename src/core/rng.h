// Reproducible random numbers: a generator is seeded from (pixel, sample, dimension). PCG32
// (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for
// Random Number Generation"), and the low-discrepancy sequences R2 (Roberts 2018) and Sobol.
#pragma once

#include "core/vec.h"

#include <stdint.h>

struct rng {
    uint64_t state, increment;
};

struct rng rng_for(uint32_t pixel, uint32_t sample, uint32_t dimension);
uint32_t rng_u32(struct rng *rng);
float rng_float(struct rng *rng);   // in [0, 1)
double rng_double(struct rng *rng); // in [0, 1), of 53 bits
vec2s rng_vec2(struct rng *rng);
// PCG hash of one word (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
uint32_t pcg_hash(uint32_t word);
// Point i of the R2 sequence, in [0, 1)².
vec2s r2_sequence(uint32_t i);
// Point i of the two-dimensional Sobol sequence, Owen-scrambled by `seed` (0: plain), in [0, 1)².
vec2s sobol_2d(uint32_t i, uint32_t seed);
// The same with `i` permuted by `seed`, so that pairs of dimensions with seeds of their own are
// independent (Burley 2020, sec. 3); i: below 2²⁰. Any aligned 2ᵏ points remain a net.
vec2s sobol_2d_padded(uint32_t i, uint32_t seed);

// ---- inline, for the path tracer

// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijective 64-bit hash.
static inline uint64_t rng_mix(uint64_t x)
{
    x ^= x >> 30;
    x *= UINT64_C(0xbf58476d1ce4e5b9);
    x ^= x >> 27;
    x *= UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

// In [0, 1), from the upper 24 bits: more would round up to 1.
static inline float rng_unit(uint32_t bits)
{
    return (float)(bits >> 8) * 0x1p-24f;
}

// Two numbers in [0, 1), from the halves of a word.
static inline vec2s rng_pair(uint64_t word)
{
    return (vec2s){ { rng_unit((uint32_t)(word >> 32)), rng_unit((uint32_t)word) } };
}
