// Directions to the map of an environment: their density, and that samples follow it.
#include "scene/environment_fixture.h"

#include "core/rng.h"
#include "trace/environment_sample.h"

static const double PI = 3.14159265358979;

static vec3s grey(float value)
{
    return vec3_of(value, value, value);
}

static vec3s uniform(vec3s d)
{
    (void)d;
    return grey(3);
}

// A smooth sky, and a window of half-angle 10° a hundred times as bright.
static vec3s window(vec3s d)
{
    const float cosine = glms_vec3_dot(d, glms_vec3_normalize(vec3_of(0.5f, 0.6f, -0.4f)));
    return glms_vec3_add(grey(1 + 0.5f * d.y), grey(cosine > cosf(10 * GLM_PIf / 180) ? 100 : 0));
}

static vec3s zenith(vec3s d)
{
    return grey(d.y > 0.97f ? 10 : 0.01f);
}

static vec3s half_black(vec3s d)
{
    return vec3_of(0, 0, fmaxf(d.x, 0));
}

static const struct sample_case {
    int width;
    fixture_radiance radiance;
    float rotation_rad;
} CASES[] = { { 16, uniform, 0 },  { 64, window, 0 },     { 300, window, 2.5f },
              { 128, zenith, -1 }, { 64, half_black, 0 }, { 90, half_black, GLM_PI_2f },
              { 1, uniform, 0 },   { 1500, window, 1 } };
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

struct sampled {
    struct environment environment;
    struct environment_table table;
};

static struct sampled begin(const struct sample_case *c)
{
    struct sampled s = { .environment = { .strength = 2, .rotation_rad = c->rotation_rad } };
    struct image one = { 1, 1, 1, &(float){ 1 } };
    s.environment.map = c->width > 1 ? fixture_map(c->width, c->radiance)
                                     : environment_map_create(test_host(), "test", &one);
    CHECK(!s.environment.map->sun.found);
    CHECK(environment_table_init(&s.table, test_host(), &s.environment));
    CHECK(environment_table_has_light(&s.table));
    return s;
}

static void end(struct sampled *s)
{
    environment_table_finish(&s->table, test_host());
    environment_map_release(s->environment.map);
}

TEST(the_density_integrates_to_one)
{
    for (int i = 0; i < CASE_COUNT; i++) {
        struct sampled s = begin(&CASES[i]);
        // Midpoints of a grid that divides the cells of the table where it is not rotated.
        const int width = 2 * s.table.width;
        double sum = 0, sr;
        for (int k = 0; k < width * (width / 2); k++) {
            const vec3s d =
                environment_world_direction(&s.environment, sphere_point(width, k, &sr));
            sum += sr * (double)environment_pdf(&s.table, &s.environment, d);
        }
        CHECK_NEAR(sum, 1, 1e-3);
        end(&s);
    }
}

// But for directions on the edge between two cells, which rounding takes to the other one.
TEST(samples_have_the_density_of_their_direction)
{
    enum { SAMPLES = 20000 };
    for (int i = 0; i < CASE_COUNT; i++) {
        struct sampled s = begin(&CASES[i]);
        struct rng rng = rng_for((uint32_t)i, 1, 0);
        int different = 0;
        for (int k = 0; k < SAMPLES; k++) {
            float pdf;
            const vec3s d = environment_sample(&s.table, &s.environment, rng_vec2(&rng), &pdf);
            CHECK(pdf > 0 && isfinite(pdf));
            CHECK_NEAR(glms_vec3_norm(d), 1, 1e-5);
            const float again = environment_pdf(&s.table, &s.environment, d);
            different += fabsf(again - pdf) > 1e-5f * pdf;
        }
        CHECK(different <= SAMPLES / 500);
        end(&s);
    }
}

TEST(the_corners_of_the_unit_square_are_valid_samples)
{
    const float corners[] = { 0, 0x1.fffffep-1f };
    for (int i = 0; i < CASE_COUNT; i++) {
        struct sampled s = begin(&CASES[i]);
        for (int k = 0; k < 4; k++) {
            float pdf;
            const vec2s u = { { corners[k % 2], corners[k / 2] } };
            const vec3s d = environment_sample(&s.table, &s.environment, u, &pdf);
            CHECK(pdf > 0 && isfinite(pdf));
            CHECK_NEAR(glms_vec3_norm(d), 1, 1e-5);
        }
        end(&s);
    }
}

// ---- samples against integrals of the density over bins of equal z and azimuth about +y

enum { ROWS = 12, COLUMNS = 12, BINS = ROWS * COLUMNS, SAMPLES = 100000 };

static int bin_of(vec3s d)
{
    const int row = (int)fminf(fmaxf((d.y + 1) / 2 * ROWS, 0), ROWS - 1);
    const float turn = atan2f(d.x, -d.z) / (2 * GLM_PIf) + 0.5f;
    return row * COLUMNS + (int)fminf(turn * COLUMNS, COLUMNS - 1);
}

// Wilson & Hilferty 1931.
static double chi_square_quantile(double freedom, double deviations)
{
    const double share = 2.0 / (9.0 * freedom);
    return freedom * pow(1.0 - share + deviations * sqrt(share), 3.0);
}

static void check_counts(const int counts[BINS], const double expected[BINS])
{
    double sum = 0, freedom = -1, rare = 0;
    int rare_count = 0;
    for (int i = 0; i < BINS; i++) {
        if (expected[i] < 10) { // too few for χ²: one bin has them all
            rare += expected[i];
            rare_count += counts[i];
            continue;
        }
        sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
        freedom += 1;
    }
    if (rare >= 10) {
        sum += (rare_count - rare) * (rare_count - rare) / rare;
        freedom += 1;
    } else
        CHECK(rare_count <= 40);
    // Fewer than one run in 30 000 is outside.
    CHECK(freedom >= 1 && sum < chi_square_quantile(freedom, 4));
}

TEST(samples_follow_the_density)
{
    for (int i = 0; i < CASE_COUNT; i++) {
        struct sampled s = begin(&CASES[i]);
        struct rng rng = rng_for((uint32_t)i, 2, 0);
        double expected[BINS] = { 0 }, total = 0;
        int counts[BINS] = { 0 };
        for (int k = 0; k < SAMPLES; k++) {
            float pdf;
            counts[bin_of(environment_sample(&s.table, &s.environment, rng_vec2(&rng), &pdf))]++;
        }
        enum { FINE = 40 }; // points of a bin, across and along
        for (int row = 0; row < ROWS * FINE; row++)
            for (int column = 0; column < COLUMNS * FINE; column++) {
                const double y = 2 * (row + 0.5) / (ROWS * FINE) - 1, r = sqrt(1 - y * y);
                const double azimuth = 2 * PI * ((column + 0.5) / (COLUMNS * FINE) - 0.5);
                const vec3s d =
                    vec3_of((float)(r * sin(azimuth)), (float)y, (float)(-r * cos(azimuth)));
                const double p = (double)environment_pdf(&s.table, &s.environment, d);
                expected[row / FINE * COLUMNS + column / FINE] += p;
                total += p;
            }
        for (int k = 0; k < BINS; k++) expected[k] *= SAMPLES / total;
        check_counts(counts, expected);
        end(&s);
    }
}

// By luminance: within a cell the density over it varies by what interpolation does.
TEST(the_density_is_that_of_the_luminance)
{
    struct sampled s = begin(&(struct sample_case){ 64, window, 0.4f });
    const double mean = (double)luminance(environment_mean(&s.environment));
    const vec3s inside = glms_vec3_normalize(vec3_of(0.5f, 0.6f, -0.4f));
    const vec3s directions[] = { inside, { { 0, -1, 0 } }, { { -0.8f, 0, 0.6f } } };
    for (int i = 0; i < 3; i++) {
        const vec3s d = environment_world_direction(&s.environment, directions[i]);
        const double l = (double)luminance(environment_radiance(&s.environment, d));
        CHECK_RELATIVE(environment_pdf(&s.table, &s.environment, d), l / (4 * PI * mean), 0.03);
    }
    end(&s);
}

TEST(without_light_there_is_no_table_and_no_density)
{
    struct image black = { 1, 1, 1, &(float){ 0 } }, white = { 1, 1, 1, &(float){ 1 } };
    struct environment_map *maps[] = { environment_map_create(test_host(), "black", &black),
                                       environment_map_create(test_host(), "white", &white) };
    const struct environment cases[] = { { .sky = grey(1) },
                                         { .map = maps[0], .strength = 1 },
                                         { .map = maps[1], .strength = 0 } };
    for (int i = 0; i < 3; i++) {
        struct environment_table table;
        CHECK(environment_table_init(&table, test_host(), &cases[i]));
        CHECK(!environment_table_has_light(&table));
        CHECK(environment_pdf(&table, &cases[i], vec3_of(0, 1, 0)) == 0);
        environment_table_finish(&table, test_host());
    }
    environment_table_finish(&(struct environment_table){ 0 }, test_host());
    environment_map_release(maps[0]);
    environment_map_release(maps[1]);
}
