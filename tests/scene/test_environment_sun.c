// Suns of images: what is one, where it is, how much light it has, and that no light is lost.
#include "framework/test.h"

#include "scene/environment/find_sun.h"
#include "scene/environment/equirect.h"
#include "scene/environment/sun_sky.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static vec3s direction_at(const struct image *image, int x, int y)
{
    return equirect_direction(equirect_texel_uv(image->width, image->height, x, y));
}

static const float RAD = GLM_PIf / 180.0f;
static const vec3s WHITE = { { 1.0f, 1.0f, 1.0f } };

static vec3s direction(float elevation_deg, float azimuth_deg)
{
    const float e = elevation_deg * RAD, a = azimuth_deg * RAD;
    return vec3_of(cosf(e) * sinf(a), sinf(e), -cosf(e) * cosf(a));
}

static void make_uniform(struct image *out, int width, int height, float radiance)
{
    CHECK(image_init(out, test_host(), width, height, 3));
    for (size_t i = 0; i < (size_t)width * (size_t)height * 3; i++) out->pixels[i] = radiance;
}

// The part of a texel's solid angle within a disc, by 16×16 points.
static float coverage(const struct image *image, int x, int y, vec3s to_disc, float radius_rad)
{
    enum { POINTS = 16 };
    const float u = ((float)x + 0.5f) / (float)image->width,
                v = ((float)y + 0.5f) / (float)image->height;
    CHECK_NEAR(glms_vec3_dot(direction_at(image, x, y),
                             direction(90.0f - 180.0f * v, 360.0f * u - 180.0f)),
               1.0, 1e-6);
    float inside = 0.0f, all = 0.0f;
    for (int i = 0; i < POINTS * POINTS; i++) {
        const float su = ((float)x + ((float)(i % POINTS) + 0.5f) / POINTS) / (float)image->width;
        const float sv = ((float)y + ((float)(i / POINTS) + 0.5f) / POINTS) / (float)image->height;
        const vec3s d = direction(90.0f - 180.0f * sv, 360.0f * su - 180.0f);
        const float weight = sinf(sv * GLM_PIf);
        all += weight;
        if (glms_vec3_norm(glms_vec3_sub(d, to_disc)) < 2.0f * sinf(0.5f * radius_rad))
            inside += weight;
    }
    return inside / all;
}

// Adds radiance · coverage of the texels near the disc; the sum of coverage · solid angle.
static double add_coverage(struct image *image, vec3s to_disc, float radius_rad, vec3s radiance)
{
    const float reach = radius_rad + 2.0f * GLM_PIf / (float)image->height;
    double sum = 0.0;
    for (int y = 0; y < image->height; y++) {
        const float elevation = GLM_PI_2f - ((float)y + 0.5f) / (float)image->height * GLM_PIf;
        if (fabsf(elevation - asinf(fminf(fmaxf(to_disc.y, -1.0f), 1.0f))) > reach) continue;
        for (int x = 0; x < image->width; x++) {
            const float cosine = glms_vec3_dot(direction_at(image, x, y), to_disc);
            if (cosine < cosf(fminf(2.0f * reach, GLM_PIf))) continue;
            const float part = coverage(image, x, y, to_disc, radius_rad);
            for (int c = 0; c < 3; c++) image_at(image, x, y)[c] += part * radiance.raw[c];
            sum += (double)part * equirect_solid_angle(image->width, image->height, y);
        }
    }
    return sum;
}

// Adds a disc of the illuminance `lux` at normal incidence.
static void add_disc(struct image *image, vec3s to_disc, float radius_deg, vec3s lux)
{
    const double sum = add_coverage(image, to_disc, radius_deg * RAD, glms_vec3_zero());
    const double cap = 4.0 * 3.14159265358979 * pow(sin((double)(0.5f * radius_deg * RAD)), 2.0);
    CHECK_RELATIVE(sum, cap, 0.06); // points are in rows at a pole
    add_coverage(image, to_disc, radius_deg * RAD, glms_vec3_scale(lux, (float)(1.0 / sum)));
}

static void sum_light(const struct image *image, double out[3])
{
    for (int c = 0; c < 3; c++) out[c] = 0.0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++)
                out[c] += equirect_solid_angle(image->width, image->height, y) *
                          (double)image_at(image, x, y)[c];
}

// Takes the sun, and no light is lost.
static struct environment_sun take(struct image *image)
{
    struct environment_sun sun;
    double before[3], after[3];
    sum_light(image, before);
    CHECK(environment_extract_sun(test_host(), image, &sun));
    sum_light(image, after);
    for (int c = 0; c < 3; c++)
        CHECK_NEAR(after[c] + (double)sun.illuminance_lux.raw[c], before[c], 1e-5 * before[c]);
    return sun;
}

static void check_sun(struct environment_sun sun, vec3s to_sun, vec3s lux, double tolerance_deg)
{
    CHECK(sun.found);
    CHECK_NEAR(glms_vec3_norm(sun.to_sun), 1.0, 1e-6);
    CHECK_NEAR(glms_vec3_norm(glms_vec3_sub(sun.to_sun, to_sun)) / RAD, 0.0, tolerance_deg);
    for (int c = 0; c < 3; c++) CHECK_RELATIVE(sun.illuminance_lux.raw[c], lux.raw[c], 0.01);
}

static void check_none(struct image *image)
{
    const size_t bytes = (size_t)image->width * (size_t)image->height * 3 * sizeof *image->pixels;
    struct image copy;
    CHECK(image_init(&copy, test_host(), image->width, image->height, 3));
    memcpy(copy.pixels, image->pixels, bytes);
    struct environment_sun sun;
    CHECK(environment_extract_sun(test_host(), image, &sun));
    CHECK(!sun.found && glms_vec3_norm(sun.illuminance_lux) == 0.0f);
    CHECK(memcmp(copy.pixels, image->pixels, bytes) == 0);
    image_finish(&copy, test_host());
}

TEST(texels_cover_the_sphere_and_their_middle_is_north)
{
    struct image image;
    double sum = 0.0;
    make_uniform(&image, 37, 19, 1);
    for (int y = 0; y < 19; y++) sum += 37.0 * equirect_solid_angle(image.width, image.height, y);
    CHECK_RELATIVE(sum, 4.0 * 3.14159265358979, 1e-12);
    CHECK_NEAR(direction_at(&image, 18, 9).z, -1.0, 1e-6);
    CHECK(direction_at(&image, 27, 9).x > 0.99f && direction_at(&image, 18, 0).y > 0.9f);
    image_finish(&image, test_host());
}

// Anywhere, also across the seam, at the poles and below the horizon.
TEST(a_sun_is_found_with_its_direction_and_its_lux)
{
    static const float places[][2] = { { 35, 20 },   { 60, -77.7f }, { 4, 180 },     { 50, 179.9f },
                                       { -30, 100 }, { 90, 0 },      { 89.8f, 130 }, { 88, -60 },
                                       { -90, 0 },   { 0, -90 } };
    const vec3s lux = vec3_of(110e3f, 95e3f, 80e3f);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const vec3s to_sun = direction(places[i][0], places[i][1]);
        struct image image;
        make_uniform(&image, 1024, 512, 4000);
        add_disc(&image, to_sun, 0.27f, lux);
        check_sun(take(&image), to_sun, lux, 0.1);
        check_none(&image);
        image_finish(&image, test_host());
    }
}

TEST(the_sun_of_a_small_image_is_found_to_a_quarter_of_a_texel)
{
    static const float azimuths[] = { 10, 10.5f, 11, 11.5f, 179.3f };
    for (size_t i = 0; i < sizeof azimuths / sizeof *azimuths; i++) {
        const vec3s to_sun = direction(40, azimuths[i]);
        struct image image;
        make_uniform(&image, 256, 128, 3000);
        add_disc(&image, to_sun, 1.5f, glms_vec3_scale(WHITE, 50e3f));
        check_sun(take(&image), to_sun, glms_vec3_scale(WHITE, 50e3f), 0.25 * 360.0 / 256.0);
        image_finish(&image, test_host());
    }
}

TEST(the_radius_is_that_of_the_disc)
{
    struct image image;
    make_uniform(&image, 1024, 512, 3000);
    add_disc(&image, direction(30, 60), 2.5f, glms_vec3_scale(WHITE, 60e3f));
    CHECK_NEAR(take(&image).radius_rad / RAD, 2.5, 0.1);
    image_finish(&image, test_host());
}

// An aureole is brighter near the sun; what the daylight model has of it stays in the image.
TEST(the_sun_of_the_daylight_model_is_taken_out_of_its_sky)
{
    static const float elevations[] = { 3, 20, 60 };
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        const struct sun_sky sky = { elevations[i] * RAD, 1.0f, 3.0f, { { 0.2f, 0.2f, 0.2f } } };
        struct sun_sky_model model;
        vec3s to_sun;
        struct image image;
        sun_sky_prepare(&sky, &model);
        const vec3s lux = sun_sky_sun(&model, &to_sun);
        CHECK(image_init(&image, test_host(), 1024, 512, 3));
        for (int y = 0; y < 512; y++)
            for (int x = 0; x < 1024; x++) {
                const vec3s radiance = sun_sky_radiance(&model, direction_at(&image, x, y));
                memcpy(image_at(&image, x, y), radiance.raw, sizeof radiance.raw);
            }
        check_none(&image);
        add_disc(&image, to_sun, 0.27f, lux);
        const struct environment_sun sun = take(&image);
        CHECK(sun.found && glms_vec3_norm(glms_vec3_sub(sun.to_sun, to_sun)) / RAD < 0.1f);
        CHECK_RELATIVE(luminance(sun.illuminance_lux), luminance(lux), 0.01);
        check_none(&image);
        image_finish(&image, test_host());
    }
}

TEST(images_without_a_small_bright_light_have_no_sun)
{
    static const int sizes[][2] = {
        { 1, 1 }, { 2, 1 }, { 1, 2 }, { 3, 2 }, { 8, 4 }, { 256, 128 }
    };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct image image;
        make_uniform(&image, sizes[i][0], sizes[i][1], 0);
        check_none(&image);
        image_finish(&image, test_host());
        make_uniform(&image, sizes[i][0], sizes[i][1], 700);
        check_none(&image);
        image_finish(&image, test_host());
        make_uniform(&image, sizes[i][0], sizes[i][1], 0);
        image.pixels[0] = 1.0f;
        struct environment_sun sun = take(&image); // one texel may be a sun where it is small
        CHECK(!sun.found || sizes[i][0] == 256);
        image_finish(&image, test_host());
    }
}

TEST(a_window_is_no_sun)
{
    static const float radii[] = { 3.5f, 5, 10, 30 };
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        struct image image;
        make_uniform(&image, 512, 256, 5);
        add_disc(&image, direction(10, 30), radii[i], glms_vec3_scale(WHITE, 20e3f));
        check_none(&image);
        image_finish(&image, test_host());
    }
}

TEST(a_tube_is_no_sun)
{
    struct image image;
    make_uniform(&image, 512, 256, 5);
    for (int x = 200; x < 240; x++)
        for (int c = 0; c < 3; c++) image_at(&image, x, 100)[c] = 1e6f;
    check_none(&image);
    image_finish(&image, test_host());
}

// π times the mean radiance is 3142 lux, and a quarter of the sun's own illuminance.
TEST(a_sun_gives_at_least_a_tenth_of_the_irradiance)
{
    static const float lux[2] = { 300, 350 };
    for (int i = 0; i < 2; i++) {
        struct image image;
        make_uniform(&image, 1024, 512, 1000);
        add_disc(&image, direction(30, 0), 0.27f, glms_vec3_scale(WHITE, lux[i]));
        if (i == 0)
            check_none(&image);
        else
            check_sun(take(&image), direction(30, 0), glms_vec3_scale(WHITE, lux[i]), 0.1);
        image_finish(&image, test_host());
    }
}

// A disc of 2.5° reaches into the ring about its edge, where its brightest texel is.
TEST(a_large_sun_is_found_whole_from_its_edge)
{
    struct image image;
    make_uniform(&image, 1024, 512, 100);
    add_disc(&image, direction(20, 40), 2.5f, glms_vec3_scale(WHITE, 5e3f));
    float *edge = image_at(&image, (int)((180.0f + 42.3f) / 360.0f * 1024.0f),
                           (int)(70.0f / 180.0f * 512.0f));
    CHECK(edge[0] > 5e5f); // inside the disc
    for (int c = 0; c < 3; c++) edge[c] *= 1.2f;
    check_sun(take(&image), direction(20, 40), glms_vec3_scale(WHITE, 5e3f), 0.1);
    image_finish(&image, test_host());
}

TEST(values_that_are_not_finite_are_left_alone)
{
    static const float values[] = { INFINITY, NAN, -INFINITY };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        struct image image;
        make_uniform(&image, 256, 128, 100);
        image_at(&image, 30, 40)[1] = values[i];
        check_none(&image);
        image_finish(&image, test_host());
    }
}

TEST(images_of_other_channels_are_refused)
{
    struct image image;
    struct environment_sun sun;
    CHECK(image_init(&image, test_host(), 4, 2, 4));
    CHECK(!environment_extract_sun(test_host(), &image, &sun));
    CHECK(test_host()->failure == FAIL_ARGUMENT && strstr(test_last_message(), "4 channels"));
    image_finish(&image, test_host());
}

static int blocks_left;

static void *scarce_reallocate(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes > 0) return blocks_left-- > 0 ? realloc(old, bytes) : NULL;
    free(old);
    return NULL;
}

TEST(without_memory_the_image_is_not_changed)
{
    for (int blocks = 0; blocks < 2; blocks++) {
        struct host host = { .reallocate = scarce_reallocate };
        struct environment_sun sun;
        struct image image;
        make_uniform(&image, 1024, 512, 1000);
        add_disc(&image, direction(30, 0), 0.27f, glms_vec3_scale(WHITE, 50e3f));
        double before[3], after[3];
        sum_light(&image, before);
        blocks_left = blocks;
        CHECK(!environment_extract_sun(&host, &image, &sun));
        CHECK(host.failure == FAIL_MEMORY && !sun.found);
        sum_light(&image, after);
        CHECK(before[0] == after[0]);
        image_finish(&image, test_host());
    }
}
