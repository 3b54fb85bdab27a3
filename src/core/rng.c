// Stateless seeding, PCG32, and two low-discrepancy sequences in fixed point.
#include "core/rng.h"

static const uint64_t PCG_MULTIPLIER = UINT64_C(6364136223846793005);

struct rng rng_for(uint32_t pixel, uint32_t sample, uint32_t dimension)
{
    static const uint64_t golden = UINT64_C(0x9e3779b97f4a7c15);
    uint64_t key = rng_mix(((uint64_t)pixel << 32 | sample) + golden);
    key = rng_mix(key ^ rng_mix(dimension + golden * 2));
    struct rng rng = { .state = key, .increment = rng_mix(key + golden) | 1 };
    rng_u32(&rng);
    return rng;
}

uint32_t rng_u32(struct rng *rng)
{
    uint64_t old = rng->state;
    rng->state = old * PCG_MULTIPLIER + rng->increment;
    uint32_t shifted = (uint32_t)(((old >> 18) ^ old) >> 27); // PCG-XSH-RR
    uint32_t rotation = (uint32_t)(old >> 59);
    return (shifted >> rotation) | (shifted << (-rotation & 31));
}

float rng_float(struct rng *rng)
{
    return rng_unit(rng_u32(rng));
}

double rng_double(struct rng *rng)
{
    const uint64_t high = rng_u32(rng), low = rng_u32(rng);
    return (double)((high << 32 | low) >> 11) * 0x1p-53;
}

vec2s rng_vec2(struct rng *rng)
{
    float x = rng_float(rng); // the order of evaluation in an initializer list is unspecified
    float y = rng_float(rng);
    return (vec2s){ { x, y } };
}

uint32_t pcg_hash(uint32_t word)
{
    uint32_t state = word * 747796405u + 2891336453u;
    uint32_t mixed = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (mixed >> 22) ^ mixed;
}

// frac(½ + i/g) and frac(½ + i/g²), g the plastic number (g³ = g + 1), in units of 2⁻³²: integer
// wrap-around is exact for every i, while floats would lose precision.
vec2s r2_sequence(uint32_t i)
{
    static const uint32_t half = 0x80000000u, inverse_g = 3242174889u, inverse_g2 = 2447445414u;
    return (vec2s){ { rng_unit(half + i * inverse_g), rng_unit(half + i * inverse_g2) } };
}

static uint32_t reverse_bits(uint32_t x)
{
    x = x << 16 | x >> 16;
    x = (x & 0x00ff00ffu) << 8 | (x & 0xff00ff00u) >> 8;
    x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
    x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
    return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

// Second dimension of Sobol 1967: direction numbers v₁ = ½, v_{k+1} = v_k ⊕ v_k/2 (primitive
// polynomial x + 1).
static uint32_t sobol_second(uint32_t i)
{
    uint32_t x = 0;
    for (uint32_t v = 0x80000000u; i; i >>= 1, v ^= v >> 1)
        if (i & 1) x ^= v;
    return x;
}

// Owen scrambling: a hash of the reversed word in which each bit depends only on the bits below it
// (Laine & Karras 2011, constants of Burley 2020, "Practical Hash-based Owen Scrambling").
static uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    x = reverse_bits(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverse_bits(x);
}

vec2s sobol_2d(uint32_t i, uint32_t seed)
{
    uint32_t x = reverse_bits(i), y = sobol_second(i);
    if (seed) {
        x = owen_scramble(x, pcg_hash(seed));
        y = owen_scramble(y, pcg_hash(seed ^ 0x9e3779b9u));
    }
    return (vec2s){ { rng_unit(x), rng_unit(y) } };
}

vec2s sobol_2d_padded(uint32_t i, uint32_t seed)
{
    static const uint32_t POINTS = UINT32_C(1) << 20; // fewer digits of the second dimension
    return sobol_2d(owen_scramble(i, pcg_hash(seed + 1u)) % POINTS, seed);
}
