// Each warp against its density: χ² of the samples, and the integral of the density.
#include "framework/test.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

enum { SAMPLES = 200000, ROWS = 16, COLUMNS = 32, CELLS = ROWS * COLUMNS };

static void check_chi_square(const int *counts, const double *expected)
{
    double sum = 0.0, freedom = -1.0;
    for (int i = 0; i < CELLS; i++) {
        if (expected[i] < 5.0) { // too few for χ²
            CHECK(counts[i] < 20);
            continue;
        }
        sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
        freedom += 1.0;
    }
    CHECK_NEAR((sum - freedom) / sqrt(2.0 * freedom), 0.0, 5.0);
}

// ---- directions, binned by z in [low, 1] and φ; the density depends on z alone

typedef vec3s (*direction_sampler)(vec2s u);
typedef double (*direction_density)(double z);

static double cell_probability(direction_density density, double low, double high)
{
    double sum = 0.0; // midpoint rule in z
    for (int i = 0; i < 64; i++) sum += density(low + (high - low) * (i + 0.5) / 64.0) / 64.0;
    return sum * (high - low) * 2.0 * PI;
}

static void check_directions(direction_sampler sampler, direction_density density, double low)
{
    int counts[CELLS] = { 0 };
    struct rng rng = rng_for(1, 2, 3);
    for (int i = 0; i < SAMPLES; i++) {
        vec3s d = sampler(rng_vec2(&rng));
        CHECK_NEAR(glms_vec3_norm(d), 1.0, 1e-5);
        CHECK((double)d.z >= low - 1e-6);
        int row = (int)(((double)d.z - low) / (1.0 - low) * ROWS);
        int column = (int)((atan2((double)d.y, (double)d.x) / (2.0 * PI) + 0.5) * COLUMNS);
        row = row < 0 ? 0 : row >= ROWS ? ROWS - 1 : row;
        counts[row * COLUMNS + (column >= COLUMNS ? COLUMNS - 1 : column)]++;
    }
    double expected[CELLS], total = 0.0;
    for (int row = 0; row < ROWS; row++) {
        double a = low + (1.0 - low) * row / ROWS, b = low + (1.0 - low) * (row + 1) / ROWS;
        double probability = cell_probability(density, a, b);
        total += probability;
        for (int column = 0; column < COLUMNS; column++)
            expected[row * COLUMNS + column] = SAMPLES * probability / COLUMNS;
    }
    CHECK_NEAR(total, 1.0, 1e-5);
    check_chi_square(counts, expected);
}

static double density_sphere(double z)
{
    (void)z;
    return 1.0 / (4.0 * PI);
}

static double density_cosine(double z)
{
    return z / PI;
}

static double density_hemisphere(double z)
{
    (void)z;
    return 1.0 / (2.0 * PI);
}

TEST(sphere_samples_match_their_density)
{
    check_directions(sample_sphere, density_sphere, -1.0);
}

TEST(cosine_samples_match_their_density)
{
    check_directions(sample_hemisphere_cosine, density_cosine, 0.0);
}

TEST(uniform_hemisphere_samples_match_their_density)
{
    check_directions(sample_hemisphere_uniform, density_hemisphere, 0.0);
}

// ---- surfaces

TEST(disk_samples_are_uniform_by_area)
{
    int counts[CELLS] = { 0 };
    struct rng rng = rng_for(7, 8, 9);
    for (int i = 0; i < SAMPLES; i++) {
        vec2s d = sample_disk(rng_vec2(&rng));
        double r2 = (double)(d.x * d.x + d.y * d.y);
        CHECK(r2 <= 1.0 + 1e-6);
        int row = (int)(r2 * ROWS);
        int column = (int)((atan2((double)d.y, (double)d.x) / (2.0 * PI) + 0.5) * COLUMNS);
        counts[(row >= ROWS ? ROWS - 1 : row) * COLUMNS +
               (column >= COLUMNS ? COLUMNS - 1 : column)]++;
    }
    double expected[CELLS];
    for (int i = 0; i < CELLS; i++) expected[i] = (double)SAMPLES / CELLS;
    check_chi_square(counts, expected);
}

TEST(disk_map_is_concentric)
{
    // Concentric squares map to circles, and the centre to itself.
    vec2s centre = sample_disk((vec2s){ { 0.5f, 0.5f } });
    CHECK(centre.x == 0.0f && centre.y == 0.0f);
    for (int i = 0; i < 100; i++) {
        float t = (float)i / 100.0f;
        vec2s side[4] = { { { 0.2f, 0.2f + 0.6f * t } },
                          { { 0.8f, 0.2f + 0.6f * t } },
                          { { 0.2f + 0.6f * t, 0.2f } },
                          { { 0.2f + 0.6f * t, 0.8f } } };
        for (int k = 0; k < 4; k++) {
            vec2s d = sample_disk(side[k]);
            CHECK_NEAR(hypot((double)d.x, (double)d.y), 0.6, 1e-6);
        }
    }
}

TEST(disk_map_has_an_inverse)
{
    struct rng rng = rng_for(3, 2, 1);
    for (int i = 0; i < 1000; i++) {
        const vec2s u = rng_vec2(&rng), back = sample_disk_inverse(sample_disk(u));
        CHECK_NEAR(back.x, u.x, 1e-6);
        CHECK_NEAR(back.y, u.y, 1e-6);
    }
    const vec2s centre = sample_disk_inverse((vec2s){ { 0.0f, 0.0f } });
    CHECK(centre.x == 0.5f && centre.y == 0.5f);
}

TEST(triangle_samples_are_uniform_by_area)
{
    enum { N = 16 };
    int counts[N * N] = { 0 };
    struct rng rng = rng_for(10, 11, 12);
    for (int i = 0; i < SAMPLES; i++) {
        vec2s b = sample_triangle(rng_vec2(&rng));
        CHECK(b.x >= 0.0f && b.y >= 0.0f && b.x + b.y <= 1.0f);
        int x = (int)(b.x * N), y = (int)(b.y * N);
        counts[y * N + x]++;
    }
    double sum = 0.0, freedom = -1.0;
    for (int y = 0; y < N; y++) {
        for (int x = 0; x + y < N; x++) {
            double share =
                (x + y == N - 1 ? 1.0 : 2.0) / (N * N); // the hypotenuse halves its cells
            double difference = counts[y * N + x] - SAMPLES * share;
            sum += difference * difference / (SAMPLES * share);
            freedom += 1.0;
        }
    }
    CHECK_NEAR((sum - freedom) / sqrt(2.0 * freedom), 0.0, 5.0);
}

TEST(corners_of_the_unit_square_give_finite_unit_directions)
{
    static const float ends[2] = { 0.0f, 0x1.fffffep-1f };
    for (int i = 0; i < 4; i++) {
        vec2s u = { { ends[i & 1], ends[i >> 1] } };
        CHECK_NEAR(glms_vec3_norm(sample_sphere(u)), 1.0, 1e-6);
        CHECK_NEAR(glms_vec3_norm(sample_hemisphere_cosine(u)), 1.0, 1e-6);
        CHECK_NEAR(glms_vec3_norm(sample_hemisphere_uniform(u)), 1.0, 1e-6);
        CHECK(sample_hemisphere_cosine(u).z >= 0.0f);
    }
}

TEST(jitter_has_mean_zero_and_each_offset_once)
{
    for (int count = 1; count <= 100; count++) {
        double x = 0, y = 0;
        for (int i = 0; i < count; i++) {
            const vec2s offset = sample_jitter(i, count);
            CHECK(fabsf(offset.x) <= 0.5f && fabsf(offset.y) <= 0.5f);
            x += (double)offset.x, y += (double)offset.y;
            for (int k = 0; k < i; k++) CHECK(sample_jitter(k, count).x != offset.x);
        }
        CHECK_NEAR(x / count, 0.0, 1e-4);
        CHECK_NEAR(y / count, 0.0, 1e-4);
    }
    const vec2s first = sample_jitter(0, 64), again = sample_jitter(-64, 64);
    CHECK(first.x == again.x && first.y == again.y);
}

// Each eighth of the pixel's width and height has its share of 64 offsets, to one.
TEST(jitter_covers_the_pixel)
{
    int columns[8] = { 0 }, rows[8] = { 0 };
    for (int i = 0; i < 64; i++) {
        const vec2s offset = sample_jitter(i, 64);
        columns[(int)fminf(8.0f * (offset.x + 0.5f), 7.0f)]++;
        rows[(int)fminf(8.0f * (offset.y + 0.5f), 7.0f)]++;
    }
    for (int i = 0; i < 8; i++) CHECK(abs(columns[i] - 8) <= 1 && abs(rows[i] - 8) <= 1);
}
