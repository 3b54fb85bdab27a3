// Generators against published outputs; chi-square and discrepancy tests.
#include "framework/test.h"

#include "core/rng.h"

#include <math.h>
#include <stdlib.h>

// χ² for equal expected counts, in standard deviations from its mean.
static double chi_square_excess(const int *counts, int bins, double expected)
{
    double sum = 0.0;
    for (int i = 0; i < bins; i++)
        sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    double freedom = bins - 1;
    return (sum - freedom) / sqrt(2.0 * freedom);
}

// The L2 star discrepancy, by the formula of Warnock 1972.
static double discrepancy(const vec2s *points, int count)
{
    double single = 0.0, pairs = 0.0;
    for (int i = 0; i < count; i++) {
        double xi = (double)points[i].x, yi = (double)points[i].y;
        single += (1.0 - xi * xi) * (1.0 - yi * yi) / 4.0;
        for (int j = 0; j < count; j++)
            pairs += (1.0 - fmax(xi, (double)points[j].x)) * (1.0 - fmax(yi, (double)points[j].y));
    }
    double n = count;
    return sqrt(1.0 / 9.0 - 2.0 / n * single + pairs / (n * n));
}

enum { POINTS = 512 };

static double random_discrepancy(void)
{
    double sum = 0.0;
    for (uint32_t run = 0; run < 8; run++) {
        vec2s points[POINTS];
        struct rng rng = rng_for(run, 0, 0);
        for (int i = 0; i < POINTS; i++) points[i] = rng_vec2(&rng);
        sum += discrepancy(points, POINTS) / 8.0;
    }
    return sum;
}

TEST(generator_gives_the_published_outputs_of_pcg32)
{
    // The first six of pcg32-demo, seeded with (42, 54): state ← (0 · a + c + 42) · a + c, c = 2·54
    // + 1.
    static const uint32_t known[6] = { 0xa15c02b7u, 0x7b47f409u, 0xba1d3330u,
                                       0x83d2f293u, 0xbfa4784bu, 0xcbed606eu };
    struct rng rng = { .state = 0, .increment = 109 };
    rng_u32(&rng);
    rng.state += 42;
    rng_u32(&rng);
    for (int i = 0; i < 6; i++) assert_int_equal(rng_u32(&rng), known[i]);
}

TEST(numbers_are_in_the_unit_interval_and_uniform)
{
    static int counts[1000];
    struct rng rng = rng_for(3, 5, 7);
    for (int i = 0; i < 1000000; i++) {
        float u = rng_float(&rng);
        CHECK(u >= 0.0f && u < 1.0f);
        counts[(int)(u * 1000.0f)]++;
    }
    CHECK(fabs(chi_square_excess(counts, 1000, 1000.0)) < 5.0);
}

TEST(doubles_are_in_the_unit_interval_and_uniform_in_high_and_low_bits)
{
    static int counts[1000], low_counts[1024];
    struct rng rng = rng_for(3, 5, 8);
    for (int i = 0; i < 1000000; i++) {
        const double u = rng_double(&rng);
        CHECK(u >= 0.0 && u < 1.0);
        counts[(int)(u * 1000.0)]++;
        low_counts[(uint64_t)(u * 0x1p53) & 1023]++;
    }
    CHECK(fabs(chi_square_excess(counts, 1000, 1000.0)) < 5.0);
    CHECK(fabs(chi_square_excess(low_counts, 1024, 1000000.0 / 1024.0)) < 5.0);
}

// Pairs of the first numbers of generators whose seeds differ by one in one argument must be
// uniform in the unit square.
static void check_neighbours(uint32_t pixel_step, uint32_t sample_step, uint32_t dimension_step)
{
    enum { CELLS = 32, PAIRS = 200000 };
    int counts[CELLS * CELLS] = { 0 };
    for (uint32_t i = 0; i < PAIRS; i++) {
        struct rng a = rng_for(i * pixel_step, i * sample_step, i * dimension_step);
        struct rng b =
            rng_for((i + 1) * pixel_step, (i + 1) * sample_step, (i + 1) * dimension_step);
        int x = (int)(rng_float(&a) * (float)CELLS), y = (int)(rng_float(&b) * (float)CELLS);
        counts[y * CELLS + x]++;
    }
    // Overlapping pairs widen the distribution of χ² slightly.
    CHECK(fabs(chi_square_excess(counts, CELLS * CELLS, (double)PAIRS / (CELLS * CELLS))) < 6.0);
}

TEST(neighbouring_pixels_samples_and_dimensions_are_independent)
{
    check_neighbours(1, 0, 0);
    check_neighbours(0, 1, 0);
    check_neighbours(0, 0, 1);
}

// Random numbers of the path tracer: the two halves of a word, and the first halves of neighbouring
// words, must be uniform in the unit square.
TEST(mixed_words_have_independent_halves_and_neighbours)
{
    enum { CELLS = 32, PAIRS = 200000 };
    static int halves[CELLS * CELLS], neighbours[CELLS * CELLS];
    for (uint64_t i = 0; i < PAIRS; i++) {
        vec2s a = rng_pair(rng_mix(i)), b = rng_pair(rng_mix(i + 1));
        CHECK(a.x >= 0.0f && a.x < 1.0f && a.y >= 0.0f && a.y < 1.0f);
        int column = (int)(a.x * (float)CELLS);
        halves[(int)(a.y * (float)CELLS) * CELLS + column]++;
        neighbours[(int)(b.x * (float)CELLS) * CELLS + column]++;
    }
    double expected = (double)PAIRS / (CELLS * CELLS);
    CHECK(fabs(chi_square_excess(halves, CELLS * CELLS, expected)) < 5.0);
    CHECK(fabs(chi_square_excess(neighbours, CELLS * CELLS, expected)) < 6.0); // overlapping pairs
}

TEST(same_arguments_give_the_same_numbers)
{
    struct rng a = rng_for(11, 22, 33), b = rng_for(11, 22, 33), c = rng_for(22, 11, 33);
    uint32_t first = rng_u32(&a);
    assert_int_equal(first, rng_u32(&b));
    assert_int_not_equal(first, rng_u32(&c));
}

TEST(pair_is_the_next_two_numbers_in_order)
{
    struct rng a = rng_for(1, 2, 3), b = a;
    vec2s pair = rng_vec2(&a);
    CHECK(pair.x == rng_float(&b));
    CHECK(pair.y == rng_float(&b));
}

TEST(hash_flips_half_of_the_bits_for_each_input_bit)
{
    for (int bit = 0; bit < 32; bit++) {
        int flipped = 0;
        for (uint32_t i = 0; i < 4000; i++)
            flipped += __builtin_popcount(pcg_hash(i * 2654435761u) ^
                                          pcg_hash((i * 2654435761u) ^ (1u << bit)));
        CHECK_NEAR(flipped / 4000.0, 16.0, 2.0);
    }
}

static int compare_words(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

TEST(hash_is_one_to_one)
{
    enum { WORDS = 1 << 20 }; // a random function would have about 128 collisions
    static uint32_t hashes[WORDS];
    for (uint32_t i = 0; i < WORDS; i++) hashes[i] = pcg_hash(i);
    qsort(hashes, WORDS, sizeof *hashes, compare_words);
    for (int i = 1; i < WORDS; i++) assert_int_not_equal(hashes[i - 1], hashes[i]);
}

TEST(r2_is_the_fractional_part_of_multiples_of_the_plastic_number)
{
    double g = 1.32471795724474602596;
    for (uint32_t i = 0; i < 100000; i += 7) {
        vec2s p = r2_sequence(i);
        double x = 0.5 + i / g, y = 0.5 + i / (g * g);
        double dx = fabs((double)p.x - (x - floor(x))), dy = fabs((double)p.y - (y - floor(y)));
        CHECK_NEAR(fmin(dx, 1.0 - dx), 0.0, 1e-5);
        CHECK_NEAR(fmin(dy, 1.0 - dy), 0.0, 1e-5);
        CHECK(p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f);
    }
}

TEST(r2_has_a_quarter_of_the_discrepancy_of_random_points)
{
    vec2s points[POINTS];
    for (uint32_t i = 0; i < POINTS; i++) points[i] = r2_sequence(i);
    CHECK(discrepancy(points, POINTS) < 0.25 * random_discrepancy());
}

TEST(sobol_has_a_quarter_of_the_discrepancy_of_random_points)
{
    double random = random_discrepancy();
    for (uint32_t seed = 0; seed < 5; seed++) {
        vec2s points[POINTS];
        for (uint32_t i = 0; i < POINTS; i++) points[i] = sobol_2d(i, seed);
        CHECK(discrepancy(points, POINTS) < 0.25 * random);
    }
}

TEST(sobol_starts_with_the_known_points)
{
    static const vec2s known[8] = {
        { { 0.0f, 0.0f } },     { { 0.5f, 0.5f } },     { { 0.25f, 0.75f } },
        { { 0.75f, 0.25f } },   { { 0.125f, 0.625f } }, { { 0.625f, 0.125f } },
        { { 0.375f, 0.375f } }, { { 0.875f, 0.875f } },
    };
    for (uint32_t i = 0; i < 8; i++) {
        vec2s p = sobol_2d(i, 0);
        CHECK(p.x == known[i].x);
        CHECK(p.y == known[i].y);
    }
}

TEST(sobol_has_one_point_in_each_elementary_interval_for_any_seed)
{
    for (uint32_t seed = 0; seed < 4; seed++) {
        for (int a = 0; a <= 8; a++) {
            int counts[256] = { 0 }, width = 1 << a, height = 1 << (8 - a);
            for (uint32_t i = 256; i < 512; i++) { // aligned blocks of 2⁸ points are (0, 8, 2)-nets
                vec2s p = sobol_2d(i, seed);
                counts[(int)(p.y * (float)height) * width + (int)(p.x * (float)width)]++;
            }
            for (int i = 0; i < 256; i++) assert_int_equal(counts[i], 1);
        }
    }
}

TEST(padded_sobol_is_a_net_whose_pairs_are_independent)
{
    enum { BLOCK = 64, STRATA = 4 };
    int joint[STRATA][STRATA] = { { 0 } };
    for (uint32_t seed = 1; seed <= 512; seed++) {
        int counts[BLOCK] = { 0 };
        for (uint32_t i = BLOCK; i < 2 * BLOCK; i++) {
            const vec2s p = sobol_2d_padded(i, seed), q = sobol_2d_padded(i, seed + 1000);
            counts[(int)(p.y * 8.0f) * 8 + (int)(p.x * 8.0f)]++;
            joint[(int)(p.x * (float)STRATA)][(int)(q.x * (float)STRATA)]++;
        }
        for (int i = 0; i < BLOCK; i++) assert_int_equal(counts[i], 1);
    }
    // Plain points of one index would share their stratum, or never do, for each pair of seeds.
    int diagonal = 0;
    for (uint32_t i = 0; i < BLOCK; i++)
        diagonal += (int)(sobol_2d_padded(i, 5).x * 8.0f) == (int)(sobol_2d_padded(i, 6).x * 8.0f);
    CHECK(diagonal > 0 && diagonal < BLOCK / 2);
    for (int i = 0; i < STRATA * STRATA; i++)
        CHECK_RELATIVE(joint[i / STRATA][i % STRATA], 512.0 * BLOCK / (STRATA * STRATA), 0.1);
}

TEST(scrambling_makes_each_point_uniform_over_seeds)
{
    enum { CELLS = 16, SEEDS = 65536 };
    for (uint32_t i = 0; i < 4; i++) {
        int counts[CELLS * CELLS] = { 0 };
        for (uint32_t seed = 1; seed <= SEEDS; seed++) {
            vec2s p = sobol_2d(i, seed);
            counts[(int)(p.y * (float)CELLS) * CELLS + (int)(p.x * (float)CELLS)]++;
        }
        CHECK(fabs(chi_square_excess(counts, CELLS * CELLS, SEEDS / (double)(CELLS * CELLS))) <
              5.0);
    }
}
