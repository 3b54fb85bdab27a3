// The GLSL twin of rng.h: a hash, numbers from it, and the R2 sequence, the same bits as in C.
#ifndef CORE_RNG_GLSL
#define CORE_RNG_GLSL

// PCG hash of one word (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
uint pcg_hash(uint word)
{
    uint state = word * 747796405u + 2891336453u;
    uint mixed = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (mixed >> 22u) ^ mixed;
}

// In [0, 1), from the upper 24 bits: more would round up to 1.
float unit_float(uint bits)
{
    return float(bits >> 8u) * (1.0 / 16777216.0);
}

// One number in [0, 1) from a pixel index, a sample index and a dimension.
float random_float(uint pixel, uint sample_index, uint dimension)
{
    return unit_float(pcg_hash(pixel + pcg_hash(sample_index + pcg_hash(dimension))));
}

// Two numbers in [0, 1), from dimensions `dimension` and `dimension` + 1.
vec2 random_vec2(uint pixel, uint sample_index, uint dimension)
{
    return vec2(random_float(pixel, sample_index, dimension),
                random_float(pixel, sample_index, dimension + 1u));
}

// Point i of the R2 sequence (Roberts 2018), in [0, 1)²; in fixed point, as r2_sequence in rng.c.
vec2 r2_sequence(uint i)
{
    return vec2(unit_float(0x80000000u + i * 3242174889u),
                unit_float(0x80000000u + i * 2447445414u));
}

#endif
