// The reference: determinism, linearity, consistency of layers, resuming and cancelling.
#include "trace/trace_fixture.h"

#include <math.h>
#include <omp.h>
#include <string.h>

static size_t float_count(const struct image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static bool images_are_equal(const struct image *a, const struct image *b)
{
    return float_count(a) == float_count(b) &&
           memcmp(a->pixels, b->pixels, float_count(a) * sizeof *a->pixels) == 0;
}

static struct image read_layer(struct reference *r, enum reference_layer layer)
{
    struct image image = { 0 };
    assert_true(reference_read(r, layer, &image));
    return image;
}

static void finish(struct image *a)
{
    image_finish(a, test_host());
}

TEST(result_does_not_depend_on_the_number_of_threads)
{
    struct image images[2];
    for (int i = 0; i < 2; i++) {
        struct trace_fixture s;
        fixture_builtin(&s, "@cornell");
        s.width = 50; // partial tiles, too
        omp_set_num_threads(i + 1);
        images[i] = fixture_layer(&s, REFERENCE_COLOR);
        fixture_finish(&s);
    }
    CHECK(image_mean(&images[0], 1) > 0);
    CHECK(images_are_equal(&images[0], &images[1]));
    finish(&images[0]);
    finish(&images[1]);
}

TEST(result_does_not_depend_on_how_samples_are_split_over_calls)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell:light=point");
    struct reference *whole = fixture_reference(&s), *parts = fixture_reference(&s);
    assert_true(reference_render(whole, 11, NULL, NULL));
    assert_true(reference_render(parts, 1, NULL, NULL));
    assert_true(reference_render(parts, 7, NULL, NULL));
    assert_true(reference_render(parts, 3, NULL, NULL));
    assert_int_equal(reference_info(parts).samples, 11);
    CHECK(reference_info(parts).rays > 11u * 32 * 32);
    struct image a = read_layer(whole, REFERENCE_COLOR), b = read_layer(parts, REFERENCE_COLOR);
    CHECK(images_are_equal(&a, &b));
    finish(&a);
    finish(&b);
    reference_destroy(whole);
    reference_destroy(parts);
    fixture_finish(&s);
}

TEST(another_seed_gives_other_noise_and_the_same_mean)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    struct image a = fixture_layer(&s, REFERENCE_COLOR);
    s.options.seed = UINT64_C(1) << 40;
    struct image b = fixture_layer(&s, REFERENCE_COLOR);
    CHECK(!images_are_equal(&a, &b));
    CHECK_RELATIVE(image_mean(&a, 1), image_mean(&b, 1), 0.1);
    finish(&a);
    finish(&b);
    fixture_finish(&s);
}

TEST(doubled_lights_give_doubled_radiance_to_the_bit)
{
    static const char *const names[][2] = { { "@cornell", "@cornell:power=2" },
                                            { "@cornell:light=point",
                                              "@cornell:light=point,power=2" } };
    for (int i = 0; i < 2; i++) {
        struct image images[2];
        for (int k = 0; k < 2; k++) {
            struct trace_fixture s;
            fixture_builtin(&s, names[i][k]);
            s.scene->environment.sky = vec3_of(10.0f * (float)(k + 1), 0, 3.0f * (float)(k + 1));
            images[k] = fixture_layer(&s, REFERENCE_COLOR);
            fixture_finish(&s);
        }
        for (size_t p = 0; p < float_count(&images[0]); p++)
            CHECK(images[1].pixels[p] == 2.0f * images[0].pixels[p]);
        finish(&images[0]);
        finish(&images[1]);
    }
}

TEST(color_is_direct_plus_indirect_to_the_bit)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    struct reference *r = fixture_reference(&s);
    assert_true(reference_render(r, 5, NULL, NULL));
    struct image color = read_layer(r, REFERENCE_COLOR), direct = read_layer(r, REFERENCE_DIRECT),
                 indirect = read_layer(r, REFERENCE_INDIRECT);
    CHECK(image_mean(&indirect, 0) > 0);
    for (size_t i = 0; i < float_count(&color); i++)
        CHECK(color.pixels[i] == direct.pixels[i] + indirect.pixels[i]);
    finish(&color);
    finish(&direct);
    finish(&indirect);
    reference_destroy(r);
    fixture_finish(&s);
}

static struct layer_mean cornell_mean(int bounces, bool direct_only, bool indirect_only)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    s.samples = 64;
    s.options.bounces = bounces;
    s.options.direct_only = direct_only;
    s.options.indirect_only = indirect_only;
    struct layer_mean m = fixture_mean(&s, REFERENCE_COLOR);
    fixture_finish(&s);
    return m;
}

TEST(one_bounce_minus_direct_light_equals_the_first_bounce)
{
    struct layer_mean one = cornell_mean(1, false, false), none = cornell_mean(0, false, false);
    struct layer_mean alone = cornell_mean(1, false, true), direct = cornell_mean(-1, true, false);
    double noise =
        sqrt(one.error * one.error + none.error * none.error + alone.error * alone.error);
    CHECK(alone.mean[1] > 10 * alone.error);
    CHECK_NEAR(one.mean[1] - none.mean[1], alone.mean[1], 4 * noise);
    CHECK_NEAR(direct.mean[1], none.mean[1], 4 * noise);
    CHECK(cornell_mean(-1, false, false).mean[1] > one.mean[1]);
}

// The indirect radiance of a diffuse surface is albedo · E / π.
TEST(indirect_light_of_a_diffuse_surface_is_albedo_over_pi_times_irradiance)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    s.options.diffuse_only = true;
    struct reference *r = fixture_reference(&s);
    assert_true(reference_render(r, 16, NULL, NULL));
    struct image indirect = read_layer(r, REFERENCE_INDIRECT),
                 albedo = read_layer(r, REFERENCE_ALBEDO),
                 irradiance = read_layer(r, REFERENCE_IRRADIANCE);
    for (size_t i = 0; i < float_count(&indirect); i++) {
        double expected =
            (double)albedo.pixels[i] * (double)irradiance.pixels[i] / 3.14159265358979;
        CHECK_NEAR(indirect.pixels[i], expected, 1e-5 * expected + 1e-6);
    }
    finish(&indirect);
    finish(&albedo);
    finish(&irradiance);
    reference_destroy(r);
    fixture_finish(&s);
}

// The reported standard error equals the deviation over seeds.
TEST(standard_error_equals_the_deviation_over_seeds)
{
    enum { RUNS = 24 };
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    s.width = s.height = 16;
    double sums[16 * 16] = { 0 }, squares[16 * 16] = { 0 }, reported = 0, measured = 0;
    for (int run = 0; run < RUNS; run++) {
        s.options.seed = (uint64_t)run;
        struct reference *r = fixture_reference(&s);
        assert_true(reference_render(r, 16, NULL, NULL));
        struct image color = read_layer(r, REFERENCE_COLOR), error = read_layer(r, REFERENCE_ERROR);
        for (size_t i = 0; i < 256; i++) {
            double v = (double)color.pixels[3 * i + 1], e = (double)error.pixels[3 * i + 1];
            sums[i] += v;
            squares[i] += v * v;
            reported += e * e / RUNS;
        }
        finish(&color);
        finish(&error);
        reference_destroy(r);
    }
    for (int i = 0; i < 256; i++) measured += (squares[i] - sums[i] * sums[i] / RUNS) / (RUNS - 1);
    CHECK_RELATIVE(reported, measured, 0.15);
    fixture_finish(&s);
}

static bool cancel_at_half(void *user, double done)
{
    double *last = user;
    CHECK(done > *last && done <= 1);
    *last = done;
    return done < 0.5;
}

TEST(a_cancelled_reference_resumes_to_the_same_image)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell:light=point");
    s.width = 400; // more tiles than one progress report
    s.height = 200;
    struct reference *whole = fixture_reference(&s), *cancelled = fixture_reference(&s);
    double last = 0;
    assert_true(reference_render(whole, 3, NULL, NULL));
    CHECK(!reference_render(cancelled, 3, cancel_at_half, &last));
    assert_int_equal(test_host()->failure, FAIL_CANCELLED);
    CHECK(last >= 0.5 && last < 1);
    int done = reference_info(cancelled).samples;
    CHECK(done >= 1 && done < 3);
    assert_true(reference_render(cancelled, 3 - done, NULL, NULL));
    struct image a = read_layer(whole, REFERENCE_COLOR), b = read_layer(cancelled, REFERENCE_COLOR);
    CHECK(images_are_equal(&a, &b));
    finish(&a);
    finish(&b);
    reference_destroy(whole);
    reference_destroy(cancelled);
    fixture_finish(&s);
}

TEST(saved_layers_restore_the_sums)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    struct reference *whole = fixture_reference(&s), *first = fixture_reference(&s),
                     *second = fixture_reference(&s);
    CHECK(reference_key(whole) == reference_key(second));
    assert_true(reference_render(whole, 12, NULL, NULL));
    assert_true(reference_render(first, 5, NULL, NULL));
    struct image layers[REFERENCE_KEPT_COUNT];
    for (int i = 0; i < REFERENCE_KEPT_COUNT; i++)
        layers[i] = read_layer(first, reference_kept_layers[i]);
    assert_true(reference_restore(second, layers));
    assert_true(reference_render(second, 7, NULL, NULL));
    for (int i = 0; i < REFERENCE_KEPT_COUNT; i++) {
        struct image a = read_layer(whole, reference_kept_layers[i]),
                     b = read_layer(second, reference_kept_layers[i]);
        CHECK(image_mean(&a, 0) > 0);
        for (size_t k = 0; k < float_count(&a); k++)
            CHECK_NEAR(b.pixels[k], a.pixels[k], 1e-3 * fabs((double)a.pixels[k]) + 1e-2);
        finish(&a);
        finish(&b);
    }
    layers[KEPT_SAMPLES].pixels[7] = 3.5f;
    CHECK(!reference_restore(second, layers));
    layers[KEPT_SAMPLES].pixels[7] = 5.0f;
    for (int i = 0; i < KEPT_SAMPLES; i++) {
        float before = layers[i].pixels[7];
        layers[i].pixels[7] = NAN;
        CHECK(!reference_restore(second, layers));
        layers[i].pixels[7] = before;
    }
    assert_int_equal(reference_info(second).samples, 0);
    layers[1].width--;
    CHECK(!reference_restore(second, layers));
    layers[1].width++;
    for (int i = 0; i < REFERENCE_KEPT_COUNT; i++) finish(&layers[i]);
    reference_destroy(whole);
    reference_destroy(first);
    reference_destroy(second);
    fixture_finish(&s);
}

static uint64_t key_of(struct trace_fixture *s)
{
    struct reference *r = fixture_reference(s);
    uint64_t key = reference_key(r);
    reference_destroy(r);
    return key;
}

TEST(keys_differ_between_images)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    uint64_t key = key_of(&s);
    CHECK(key == key_of(&s));
    s.options.seed = 1;
    CHECK(key != key_of(&s));
    s.options.seed = 0;
    s.options.bounces = 3;
    CHECK(key != key_of(&s));
    s.options.bounces = -1;
    s.camera.eye.x += 0.001f;
    CHECK(key != key_of(&s));
    s.camera.eye.x -= 0.001f;
    s.scene->environment.sky.x = 1;
    CHECK(key != key_of(&s));
    s.scene->environment.sky.x = 0;
    s.scene->materials[0].roughness *= 0.5f;
    CHECK(key != key_of(&s));
    fixture_finish(&s);
}

TEST(invalid_arguments_are_refused)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    struct reference_options wrong = s.options, both = s.options;
    wrong.bounces = -2;
    both.direct_only = both.indirect_only = true;
    struct host *host = test_host();
    CHECK(!reference_create(host, &s.pose, &s.camera, 0, 8, &s.options));
    CHECK(!reference_create(host, &s.pose, &s.camera, 8, IMAGE_MAX_SIZE + 1, &s.options));
    CHECK(!reference_create(host, &s.pose, &s.camera, 8, 8, &wrong));
    CHECK(!reference_create(host, &s.pose, &s.camera, 8, 8, &both));
    struct reference *r = fixture_reference(&s);
    CHECK(!reference_render(r, 0, NULL, NULL));
    CHECK(!reference_render(r, -1, NULL, NULL));
    reference_destroy(r);
    reference_destroy(NULL);
    trace_scene_destroy(NULL);
    fixture_finish(&s);
}

TEST(an_empty_scene_shows_the_sky)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.scene->environment.sky = vec3_of(1, 2, 3);
    struct layer_mean m = fixture_mean(&s, REFERENCE_COLOR);
    CHECK_NEAR(m.mean[0], 1, 0);
    CHECK_NEAR(m.mean[2], 3, 0);
    CHECK_NEAR(m.error, 0, 0);
    fixture_finish(&s);
}
