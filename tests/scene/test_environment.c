// The environment: its map by direction, its spherical harmonics and its identity.
#include "scene/environment_fixture.h"

#include "core/rng.h"

#include <stdio.h>

static const double PI = 3.14159265358979;

static const vec3s DIRECTIONS[] = { { { 1, 0, 0 } },
                                    { { 0, -1, 0 } },
                                    { { 0.36f, 0.48f, -0.8f } } };

TEST(spherical_harmonics_have_the_radiance_and_the_irradiance)
{
    const struct environment environment = { .sky = vec3_of(3, 5, 7) };
    float coefficients[3][SH_MAX_COUNT];
    environment_sh(&environment, 3, coefficients);
    for (size_t d = 0; d < sizeof DIRECTIONS / sizeof *DIRECTIONS; d++) {
        const vec3s radiance = environment_radiance(&environment, DIRECTIONS[d]);
        for (int c = 0; c < 3; c++) {
            float irradiance[9];
            sh_irradiance(3, coefficients[c], irradiance);
            CHECK_RELATIVE(sh_dot(3, coefficients[c], DIRECTIONS[d]), radiance.raw[c], 1e-6);
            CHECK_RELATIVE(sh_dot(3, irradiance, DIRECTIONS[d]), PI * (double)radiance.raw[c],
                           1e-6);
            CHECK_RELATIVE(radiance.raw[c], environment_mean(&environment).raw[c], 1e-6);
        }
    }
}

// ---- hosts that count

struct counts {
    int warnings;
    long blocks;
    char last[256];
};

static void count_log(void *user, enum log_level level, const char *message)
{
    struct counts *counts = user;
    if (level > LOG_WARNING) return;
    counts->warnings++;
    snprintf(counts->last, sizeof counts->last, "%s", message);
}

static void *count_reallocate(void *user, void *old, size_t bytes)
{
    struct counts *counts = user;
    counts->blocks += (bytes > 0) - (old != NULL);
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

static struct host counting_host(struct counts *counts)
{
    *counts = (struct counts){ 0 };
    return (struct host){
        .log = count_log, .reallocate = count_reallocate, .user = counts, .log_up_to = LOG_WARNING
    };
}

// ---- images

static struct environment_map *map_of(struct host *host, int width, int height, int channels,
                                      float *pixels)
{
    const struct image image = { width, height, channels, pixels };
    struct environment_map *map = environment_map_create(host, "test.hdr", &image);
    assert_non_null(map);
    return map;
}

// Values of 0 to 1, differing by colour.
static float *random_pixels(int width, int height, uint32_t seed)
{
    const size_t values = 3 * (size_t)width * (size_t)height;
    float *pixels = malloc(values * sizeof *pixels);
    assert_non_null(pixels);
    struct rng rng = rng_for(seed, 0, 0);
    for (size_t i = 0; i < values; i++) pixels[i] = rng_float(&rng);
    return pixels;
}

static struct environment_map *random_map(int width, int height, uint32_t seed)
{
    float *pixels = random_pixels(width, height, seed);
    struct environment_map *map = map_of(test_host(), width, height, 3, pixels);
    free(pixels);
    return map;
}

static void check_colour(vec3s a, vec3s b, double tolerance)
{
    for (int c = 0; c < 3; c++) CHECK_NEAR(a.raw[c], b.raw[c], tolerance);
}

// ---- lookup

static vec3s texel_direction(int width, int height, int x, int y)
{
    const double polar = PI * (y + 0.5) / height, azimuth = 2 * PI * ((x + 0.5) / width - 0.5);
    return vec3_of((float)(sin(polar) * sin(azimuth)), (float)cos(polar),
                   (float)(-sin(polar) * cos(azimuth)));
}

TEST(the_middle_of_a_texel_has_its_value)
{
    static const int sizes[][2] = { { 32, 16 }, { 7, 5 }, { 1, 1 }, { 1, 6 }, { 2, 1 }, { 3, 40 } };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int width = sizes[i][0], height = sizes[i][1];
        float *pixels = random_pixels(width, height, 1);
        struct environment_map *map = map_of(test_host(), width, height, 3, pixels);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const float *texel = pixels + 3 * (y * width + x);
                check_colour(environment_map_radiance(map, texel_direction(width, height, x, y)),
                             vec3_of(texel[0], texel[1], texel[2]), 2e-5);
            }
        environment_map_release(map);
        free(pixels);
    }
}

// Red about the centre, green a quarter to the right of it, blue in the top row.
static struct environment_map *axes_map(void)
{
    float pixels[4 * 8 * 3] = { 0 };
    for (int y = 1; y <= 2; y++)
        for (int x = 3; x <= 4; x++) {
            pixels[3 * (8 * y + x)] = 1;
            pixels[3 * (8 * y + x + 2) + 1] = 1;
        }
    for (int x = 0; x < 8; x++) pixels[3 * x + 2] = 1;
    return map_of(test_host(), 8, 4, 3, pixels);
}

TEST(the_centre_of_an_image_is_minus_z_right_of_it_plus_x_the_top_plus_y)
{
    struct environment_map *map = axes_map();
    check_colour(environment_map_radiance(map, vec3_of(0, 0, -1)), vec3_of(1, 0, 0), 1e-6);
    check_colour(environment_map_radiance(map, vec3_of(1, 0, 0)), vec3_of(0, 1, 0), 1e-6);
    check_colour(environment_map_radiance(map, vec3_of(0, 1, 0)), vec3_of(0, 0, 1), 1e-6);
    check_colour(environment_map_radiance(map, vec3_of(-1, 0, 0)), vec3_of(0, 0, 0), 1e-6);
    check_colour(environment_map_radiance(map, vec3_of(0, 0, 1)), vec3_of(0, 0, 0), 1e-6);
    check_colour(environment_map_radiance(map, vec3_of(0, -1, 0)), vec3_of(0, 0, 0), 1e-6);
    environment_map_release(map);
}

TEST(columns_wrap_behind)
{
    float *pixels = random_pixels(6, 3, 2);
    struct environment_map *map = map_of(test_host(), 6, 3, 3, pixels);
    const float *first = pixels + 3 * 6, *last = first + 3 * 5;
    const vec3s mean = vec3_of(0.5f * (first[0] + last[0]), 0.5f * (first[1] + last[1]),
                               0.5f * (first[2] + last[2]));
    check_colour(environment_map_radiance(map, vec3_of(0, 0, 1)), mean, 1e-5);
    check_colour(environment_map_radiance(map, vec3_of(-0.0f, 0, 1)), mean, 1e-5);
    check_colour(environment_map_radiance(map, vec3_of(1e-6f, 0, 1)), mean, 1e-5);
    check_colour(environment_map_radiance(map, vec3_of(-1e-6f, 0, 1)), mean, 1e-5);
    environment_map_release(map);
    free(pixels);
}

// Seen from above, with −z up and +x to the right, a quarter turn counterclockwise takes −z to −x.
TEST(environments_turn_counterclockwise_seen_from_above)
{
    struct environment_map *map = axes_map();
    struct environment e = { .map = map, .strength = 2, .rotation_rad = GLM_PI_2f };
    check_colour(environment_world_direction(&e, vec3_of(0, 0, -1)), vec3_of(-1, 0, 0), 1e-6);
    check_colour(environment_world_direction(&e, vec3_of(1, 0, 0)), vec3_of(0, 0, -1), 1e-6);
    check_colour(environment_radiance(&e, vec3_of(-1, 0, 0)), vec3_of(2, 0, 0), 1e-5);
    check_colour(environment_radiance(&e, vec3_of(0, 0, -1)), vec3_of(0, 2, 0), 1e-5);
    check_colour(environment_radiance(&e, vec3_of(0, 1, 0)), vec3_of(0, 0, 2), 1e-5);
    e.rotation_rad = 0.7f;
    e.sky = vec3_of(1, 2, 3);
    struct rng rng = rng_for(3, 0, 0);
    for (int i = 0; i < 100; i++) {
        const vec3s d = glms_vec3_normalize(
            vec3_of(rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f, rng_float(&rng) - 0.5f));
        const vec3s there = environment_world_direction(&e, d);
        check_colour(environment_map_direction(&e, there), d, 1e-6);
        check_colour(environment_radiance(&e, there),
                     glms_vec3_muladds(environment_map_radiance(map, d), 2, e.sky), 2e-5);
    }
    environment_map_release(map);
}

// ---- spherical harmonics

// Coefficients of 6 bands and the mean, by quadrature of the radiance from each direction.
static void integrate(const struct environment *e, int width, double sh[3][SH_MAX_COUNT],
                      double mean[3])
{
    double sr;
    memset(sh, 0, sizeof(double[3][SH_MAX_COUNT]));
    mean[0] = mean[1] = mean[2] = 0.0;
    for (int i = 0; i < width * (width / 2); i++) {
        float basis[SH_MAX_COUNT];
        const vec3s d = sphere_point(width, i, &sr);
        const vec3s radiance = environment_radiance(e, d);
        sh_eval(SH_MAX_BANDS, d, basis);
        for (int c = 0; c < 3; c++) {
            mean[c] += sr * (double)radiance.raw[c] / (4 * PI);
            for (int k = 0; k < SH_MAX_COUNT; k++)
                sh[c][k] += sr * (double)radiance.raw[c] * (double)basis[k];
        }
    }
}

static void check_sh(const struct environment *e, int width)
{
    double expected[3][SH_MAX_COUNT], mean[3];
    float got[3][SH_MAX_COUNT];
    integrate(e, width, expected, mean);
    for (int c = 0; c < 3; c++) CHECK_RELATIVE(environment_mean(e).raw[c], mean[c], 1e-3);
    for (int bands = 2; bands <= SH_MAX_BANDS; bands++) {
        environment_sh(e, bands, got);
        for (int c = 0; c < 3; c++) {
            double norm = 0;
            for (int k = 0; k < SH_COUNT(bands); k++) norm += expected[c][k] * expected[c][k];
            for (int k = 0; k < SH_COUNT(bands); k++)
                CHECK_NEAR(got[c][k], expected[c][k], 1e-3 * sqrt(norm));
        }
    }
}

TEST(spherical_harmonics_and_mean_equal_a_quadrature_of_the_radiance)
{
    struct environment_map *map = random_map(32, 16, 4);
    check_sh(&(struct environment){ .map = map, .strength = 1 }, 512);
    check_sh(&(struct environment){ .map = map, .strength = 3, .rotation_rad = 2 }, 512);
    check_sh(&(struct environment){ .sky = vec3_of(0.2f, 0, 0.5f),
                                    .map = map,
                                    .strength = 0.5f,
                                    .rotation_rad = -GLM_PI_2f },
             512);
    environment_map_release(map);
    map = random_map(3, 2, 5);
    check_sh(&(struct environment){ .map = map, .strength = 1, .rotation_rad = 1 }, 512);
    environment_map_release(map);
}

// Widths above and below that of the projection's grid, which they do not divide.
TEST(spherical_harmonics_of_fine_images_equal_a_quadrature_of_the_radiance)
{
    static const int sizes[][2] = { { 700, 350 }, { 400, 300 }, { 20, 600 } };
    for (int i = 0; i < 3; i++) {
        struct environment_map *map = random_map(sizes[i][0], sizes[i][1], 6);
        check_sh(&(struct environment){ .map = map, .strength = 1, .rotation_rad = 0.5f }, 1000);
        environment_map_release(map);
    }
}

static vec3s uniform(vec3s d)
{
    (void)d;
    return vec3_of(4, 5, 6);
}

static vec3s half_cosine(vec3s d)
{
    const float cosine = fmaxf(glms_vec3_dot(d, vec3_of(0.6f, 0.48f, 0.64f)), 0);
    return vec3_of(cosine, 2 * cosine, cosine);
}

// A clamped cosine has 1 − Σ_l z_l² / (2π/3) of its energy beyond the bands l, z of sh.h.
TEST(sh_error_is_the_share_that_the_bands_lack)
{
    const double energy[] = { PI / 4 + PI / 3, 5 * PI / 64, 0, PI / 256 };
    struct environment_map *map = fixture_map(256, half_cosine);
    double found = 0;
    for (int i = 0; i < 4; i++) {
        found += energy[i];
        CHECK_RELATIVE(map->sh_error[i], sqrt(1 - found / (2 * PI / 3)), 0.01);
    }
    environment_map_release(map);
    map = fixture_map(64, uniform);
    for (int i = 0; i < 4; i++) CHECK_NEAR(map->sh_error[i], 0, 1e-3);
    environment_map_release(map);
    map = random_map(32, 16, 7);
    for (int i = 1; i < 4; i++) CHECK(map->sh_error[i] < map->sh_error[i - 1]);
    environment_map_release(map);
}

// ---- content

static void sum_light(const float *pixels, int width, int height, double sum[3])
{
    sum[0] = sum[1] = sum[2] = 0.0;
    for (int y = 0; y < height; y++) {
        const double sr = 2 * PI / width * (cos(PI * y / height) - cos(PI * (y + 1) / height));
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                sum[c] +=
                    sr * (double)pixels[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c];
    }
}

TEST(shrinking_an_image_keeps_its_light)
{
    static const int sizes[][2] = {
        { 5000, 3 }, { 8192, 2 }, { 4097, 7 }, { 5, 3001 }, { 1, 4096 }
    };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int width = sizes[i][0], height = sizes[i][1];
        float *pixels = random_pixels(width, height, 8);
        double before[3], after[3];
        struct environment_map *map = map_of(test_host(), width, height, 3, pixels);
        const struct image *image = &map->radiance;
        CHECK(!map->sun.found && image->width <= ENVIRONMENT_MAX_WIDTH &&
              image->height <= ENVIRONMENT_MAX_WIDTH / 2);
        sum_light(pixels, width, height, before);
        sum_light(image->pixels, image->width, image->height, after);
        for (int c = 0; c < 3; c++) CHECK_RELATIVE(after[c], before[c], 1e-5);
        environment_map_release(map);
        free(pixels);
    }
}

TEST(values_that_are_no_radiance_are_black_with_one_warning_that_counts_them)
{
    const float wrong[] = { NAN, -1, INFINITY, -INFINITY, 1e16f };
    enum { COUNT = sizeof wrong / sizeof *wrong };
    float pixels[8 * 4 * 3];
    struct counts counts;
    struct host host = counting_host(&counts);
    for (int i = 0; i < 8 * 4 * 3; i++) pixels[i] = 1;
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) pixels[3 * (3 * i + 1) + c] = wrong[i];
    struct environment_map *map = map_of(&host, 8, 4, 3, pixels);
    assert_int_equal(counts.warnings, 1);
    CHECK(strstr(counts.last, "test.hdr") && strstr(counts.last, ": 5 pixels"));
    for (int i = 0; i < 8 * 4; i++)
        for (int c = 0; c < 3; c++)
            CHECK(map->radiance.pixels[3 * i + c] == (i % 3 == 1 && i < 3 * COUNT ? 0 : 1));
    CHECK(map->peak == 1);
    environment_map_release(map);
    assert_int_equal(counts.blocks, 0);
}

TEST(a_black_image_is_told_and_valid)
{
    float pixels[2 * 3] = { 0 };
    struct counts counts;
    struct host host = counting_host(&counts);
    struct environment_map *map = map_of(&host, 2, 1, 3, pixels);
    const struct environment e = { .map = map, .strength = 1 };
    assert_int_equal(counts.warnings, 1);
    CHECK(strstr(counts.last, "test.hdr") && strstr(counts.last, "black"));
    CHECK(environment_is_black(&e) && map->peak == 0);
    for (int i = 0; i < 4; i++) CHECK(map->sh_error[i] == 0);
    environment_map_release(map);
    assert_int_equal(counts.blocks, 0);
}

// One channel is grey; a fourth is no light.
TEST(images_have_one_channel_or_three_that_count)
{
    float grey[] = { 2, 3 }, four[] = { 1, 2, 3, NAN, 4, 5, 6, -1 };
    struct counts counts;
    struct host host = counting_host(&counts);
    struct environment_map *map = map_of(&host, 2, 1, 1, grey);
    check_colour(environment_map_radiance(map, vec3_of(1, 0, 0)), vec3_of(3, 3, 3), 1e-6);
    environment_map_release(map);
    map = map_of(&host, 2, 1, 4, four);
    check_colour(environment_map_radiance(map, vec3_of(-1, 0, 0)), vec3_of(1, 2, 3), 1e-5);
    check_colour(environment_map_radiance(map, vec3_of(1, 0, 0)), vec3_of(4, 5, 6), 1e-5);
    environment_map_release(map);
    assert_int_equal(counts.warnings, 0);
    assert_int_equal(counts.blocks, 0);
}

TEST(the_last_user_of_a_map_destroys_it)
{
    float pixels[] = { 1, 2, 3 };
    struct counts counts;
    struct host host = counting_host(&counts);
    struct environment_map *map = map_of(&host, 1, 1, 3, pixels);
    environment_map_retain(map);
    environment_map_retain(map);
    environment_map_release(map);
    environment_map_release(map);
    CHECK(counts.blocks > 0);
    check_colour(environment_map_radiance(map, vec3_of(0, 1, 0)), vec3_of(1, 2, 3), 1e-6);
    environment_map_release(map);
    assert_int_equal(counts.blocks, 0);
    environment_map_retain(NULL);
    environment_map_release(NULL);
}

TEST(the_key_is_of_the_radiance)
{
    float pixels[] = { 1, 2, 3, 4, 5, 6 };
    struct environment_map *map = map_of(test_host(), 2, 1, 3, pixels);
    struct environment_map *same = map_of(test_host(), 2, 1, 3, pixels);
    struct environment_map *upright = map_of(test_host(), 1, 2, 3, pixels);
    pixels[5] = 7;
    struct environment_map *other = map_of(test_host(), 2, 1, 3, pixels);
    const struct environment e = { .map = map, .strength = 1, .rotation_rad = 1 };
    const uint64_t key = environment_key(&e);
    struct environment changed = e;
    changed.map = same;
    CHECK(environment_key(&changed) == key);
    changed.map = other;
    CHECK(environment_key(&changed) != key);
    changed.map = upright;
    CHECK(environment_key(&changed) != key);
    changed.map = NULL;
    CHECK(environment_key(&changed) != key);
    changed.strength = 2; // of no map
    CHECK(environment_key(&changed) == environment_key(&(struct environment){ 0 }));
    changed = e;
    changed.strength = 2;
    CHECK(environment_key(&changed) != key);
    changed = e;
    changed.rotation_rad = 2;
    CHECK(environment_key(&changed) != key);
    changed = e;
    changed.sky.y = 1;
    CHECK(environment_key(&changed) != key);
    environment_map_release(map);
    environment_map_release(same);
    environment_map_release(upright);
    environment_map_release(other);
}
