#include "test_images.h"

#include "image/metrics.h"
#include "image/tonemap.h"

#include <math.h>
#include <string.h>

static struct metrics measure(const struct image *a, const struct image *b)
{
    struct metrics m;
    CHECK(metrics_compute(test_host(), a, b, NULL, &m));
    return m;
}

static void fill(struct image *image, int width, int height, const float *values)
{
    CHECK(image_init(image, test_host(), width, height, 3));
    memcpy(image->pixels, values, (size_t)width * (size_t)height * 3 * sizeof(float));
}

TEST(equal_images_have_no_error_and_infinite_psnr)
{
    struct image a;
    noise_image(&a, 9, 5, 3);
    struct metrics m = measure(&a, &a);
    CHECK(m.mse == 0.0 && m.mae == 0.0 && m.relmse == 0.0 && isinf(m.psnr) && m.psnr > 0.0);
    CHECK(memcmp(m.mean_a, m.mean_b, sizeof m.mean_a) == 0);
    image_finish(&a, test_host());
}

TEST(metrics_of_two_pixels_are_as_computed_by_hand)
{
    struct image a, b;
    fill(&a, 2, 1, (const float[]){ 0.5f, 1.0f, 0.25f, 1.0f, 0.0f, 0.5f });
    fill(&b, 2, 1, (const float[]){ 1.0f, 1.0f, 0.0f, 0.5f, 0.0f, 1.0f });
    struct metrics m = measure(&a, &b);
    // differences: −½ 0 ¼ ½ 0 −½
    CHECK_NEAR(m.mse, (3 * 0.25 + 0.0625) / 6, 1e-12);
    CHECK_NEAR(m.mae, 1.75 / 6, 1e-12);
    CHECK_NEAR(m.psnr, -10 * log10(0.8125 / 6), 1e-9);
    double mean = 0.2126 * 0.75 + 0.7152 * 0.5 + 0.0722 * 0.5, e = 0.01 * mean * mean;
    double relative = 0.25 / (1 + e) + 0.0625 / e + 0.25 / (0.25 + e) + 0.25 / (1 + e);
    CHECK_RELATIVE(m.relmse, relative / 6, 1e-12);
    CHECK_NEAR(m.mean_a[0], 0.75, 1e-12);
    CHECK_NEAR(m.mean_b[2], 0.5, 1e-12);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(relmse_against_black_divides_by_a_tenth_squared)
{
    struct image a, b;
    flat_image(&a, 3, 3, 3, 0.02f);
    flat_image(&b, 3, 3, 3, 0.0f);
    CHECK_RELATIVE(measure(&a, &b).relmse, 0.04, 1e-6);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(relmse_does_not_change_with_exposure)
{
    struct image a, b;
    noise_image(&a, 16, 9, 3);
    noise_image(&b, 16, 9, 3);
    for (int i = 0; i < 16 * 9 * 3; i++)
        a.pixels[i] = fabsf(a.pixels[i]), b.pixels[i] = 0.5f * a.pixels[i] + 3.0f;
    struct metrics before = measure(&a, &b);
    for (int i = 0; i < 16 * 9 * 3; i++) a.pixels[i] *= 64.0f, b.pixels[i] *= 64.0f;
    struct metrics after = measure(&a, &b);
    CHECK_RELATIVE(after.relmse, before.relmse, 1e-9);
    CHECK_RELATIVE(after.mse, before.mse * 64 * 64, 1e-9);
    CHECK_RELATIVE(after.mae, before.mae * 64, 1e-9);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(mse_mae_and_psnr_are_symmetric)
{
    struct image a, b;
    noise_image(&a, 16, 9, 3);
    noise_image(&b, 16, 9, 4); // other values; the fourth channel does not count
    struct metrics ab = measure(&a, &b), ba = measure(&b, &a);
    CHECK(ab.mse == ba.mse && ab.mae == ba.mae && ab.psnr == ba.psnr);
    CHECK(ab.mse > 0.0 && ab.mse >= ab.mae * ab.mae); // Jensen
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(more_of_the_same_error_is_a_larger_error)
{
    struct image a, b;
    noise_image(&b, 16, 9, 3);
    struct metrics last = { .psnr = INFINITY };
    for (int step = 1; step < 6; step++) {
        noise_image(&a, 16, 9, 3);
        for (int i = 0; i < 16 * 9 * 3; i++) a.pixels[i] += 0.1f * (float)(step * (i % 7));
        struct metrics m = measure(&a, &b);
        CHECK(m.mse > last.mse && m.mae > last.mae && m.relmse > last.relmse && m.psnr < last.psnr);
        last = m;
        image_finish(&a, test_host());
    }
    image_finish(&b, test_host());
}

TEST(the_error_for_a_size_mismatch_has_both_sizes)
{
    struct image a, b, map;
    struct metrics m;
    flat_image(&a, 6, 4, 3, 0.0f);
    flat_image(&b, 5, 3, 3, 0.0f);
    CHECK(!metrics_compute(test_host(), &a, &b, NULL, &m));
    CHECK(strstr(test_last_message(), "6x4") && strstr(test_last_message(), "5x3"));
    CHECK(test_host()->failure == FAIL_ARGUMENT);
    CHECK(!metrics_error_map(test_host(), &a, &b, NULL, METRICS_ABSOLUTE, 1.0f, &map));
    CHECK(!map.pixels);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(too_few_channels_are_refused)
{
    struct image a, b;
    struct metrics m;
    flat_image(&a, 2, 2, 3, 0.0f);
    flat_image(&b, 2, 2, 1, 0.0f);
    CHECK(!metrics_compute(test_host(), &a, &b, NULL, &m));
    CHECK(!metrics_compute(test_host(), &b, &a, NULL, &m));
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(pixels_that_are_not_finite_are_counted_in_the_message)
{
    struct image a, b;
    struct metrics m;
    flat_image(&a, 8, 8, 3, 1.0f);
    flat_image(&b, 8, 8, 3, 1.0f);
    for (int i = 0; i < 5; i++) image_at(&a, i, 2)[i % 3] = NAN;
    CHECK(!metrics_compute(test_host(), &a, &b, NULL, &m));
    CHECK(strstr(test_last_message(), "5 of 64 pixels of the image"));
    CHECK(!metrics_compute(test_host(), &b, &a, NULL, &m));
    CHECK(strstr(test_last_message(), "5 of 64 pixels of the reference"));
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

static float map_luminance(const struct image *map, int x)
{
    const float *p = image_at(map, x, 0);
    return luminance(vec3_of(p[0], p[1], p[2]));
}

TEST(the_error_map_rises_in_lightness_as_the_error_does)
{
    enum { N = 201 };
    struct image a, b, map;
    flat_image(&b, N, 1, 3, 1.0f);
    flat_image(&a, N, 1, 3, 1.0f);
    for (int x = 0; x < N; x++)
        for (int c = 0; c < 3; c++) image_at(&a, x, 0)[c] += 2.0f * (float)x / (float)(N - 1);
    CHECK(metrics_error_map(test_host(), &a, &b, NULL, METRICS_ABSOLUTE, 2.0f, &map));
    CHECK(map.channels == 3 && map.width == N && map.height == 1);
    CHECK_NEAR((double)map_luminance(&map, 0), 0.0, 1e-6);
    CHECK_NEAR((double)map_luminance(&map, N - 1), 1.0, 1e-4);
    double before = -1.0;
    for (int x = 0; x < N; x++) {
        // CIE lightness, 0…100, in equal steps for all hues; OKLab and CIE differ by up to 2.8.
        double y = (double)map_luminance(&map, x);
        double lightness = y > 0.008856 ? 116.0 * cbrt(y) - 16.0 : 903.3 * y;
        CHECK(lightness > before);
        before = lightness;
        CHECK_NEAR(lightness, 100.0 * x / (N - 1), 3.0);
        for (int c = 0; c < 3; c++)
            CHECK(image_at(&map, x, 0)[c] >= 0.0f && image_at(&map, x, 0)[c] <= 1.0f);
    }
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&map, test_host());
}

TEST(the_automatic_scale_of_the_error_map_is_the_99th_percentile)
{
    struct image a, b, automatic, given;
    flat_image(&a, 200, 1, 3, 0.0f);
    flat_image(&b, 200, 1, 3, 0.0f);
    for (int x = 0; x < 200; x++) // errors 1…200, in scrambled order; two lie above the percentile
        for (int c = 0; c < 3; c++) image_at(&a, x, 0)[c] = (float)((x * 77) % 200 + 1);
    CHECK(metrics_error_map(test_host(), &a, &b, NULL, METRICS_ABSOLUTE, 0.0f, &automatic));
    CHECK(metrics_error_map(test_host(), &a, &b, NULL, METRICS_ABSOLUTE, 198.0f, &given));
    CHECK(memcmp(automatic.pixels, given.pixels, 200 * 3 * sizeof(float)) == 0);
    image_finish(&automatic, test_host());
    image_finish(&given, test_host());
    CHECK(metrics_error_map(test_host(), &b, &b, NULL, METRICS_ABSOLUTE, -1.0f, &automatic));
    for (int i = 0; i < 600; i++) CHECK_NEAR((double)automatic.pixels[i], 0.0, 1e-6);
    image_finish(&automatic, test_host());
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(a_single_wrong_pixel_stays_visible_in_the_error_map)
{
    struct image a, b, map;
    flat_image(&a, 40, 30, 3, 0.5f);
    flat_image(&b, 40, 30, 3, 0.5f);
    image_at(&a, 7, 9)[1] = 4.0f;
    CHECK(metrics_error_map(test_host(), &a, &b, NULL, METRICS_ABSOLUTE, 0.0f, &map));
    CHECK_NEAR((double)image_at(&map, 7, 9)[0], 1.0, 1e-4);
    CHECK_NEAR((double)image_at(&map, 8, 9)[0], 0.0, 1e-6);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&map, test_host());
}

// ---- tone mapping and masks

TEST(radiance_is_tone_mapped_with_one_exposure_and_display_values_are_not)
{
    struct image a, b, shown_a, shown_b;
    const struct metrics_options radiance = { .radiance = true, .ev = 3.0f };
    display_image(&a, 24, 17, 3, 1);
    display_image(&b, 24, 17, 3, 2);
    for (int i = 0; i < 24 * 17 * 3; i++) a.pixels[i] *= 20.0f, b.pixels[i] *= 20.0f;
    CHECK(image_tonemap(&shown_a, test_host(), &a, 3.0f, TONEMAP_NEUTRAL));
    CHECK(image_tonemap(&shown_b, test_host(), &b, 3.0f, TONEMAP_NEUTRAL));
    struct metrics light, display = measure(&shown_a, &shown_b), unscaled = measure(&a, &b);
    CHECK(metrics_compute(test_host(), &a, &b, &radiance, &light));
    CHECK(light.flip == display.flip && light.ssim == display.ssim);
    CHECK(light.flip != unscaled.flip);
    CHECK(light.mse == unscaled.mse &&
          light.relmse == unscaled.relmse); // of radiance, not of display values
    CHECK(light.flip_hdr > 0.0 && light.flip_hdr <= 1.0 && isnan(display.flip_hdr));
    CHECK(light.counted == 24 * 17 && light.ignored == 0);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&shown_a, test_host());
    image_finish(&shown_b, test_host());
}

TEST(only_pixels_in_the_mask_count)
{
    struct image a, b, mask, half_a, half_b;
    display_image(&a, 20, 10, 3, 1);
    display_image(&b, 20, 10, 3, 2);
    flat_image(&mask, 20, 10, 2, -1.0f);
    CHECK(image_init(&half_a, test_host(), 10, 10, 3));
    CHECK(image_init(&half_b, test_host(), 10, 10, 3));
    for (int y = 0; y < 10; y++)
        for (int x = 0; x < 20; x++) {
            if (x >= 10) {
                image_at(&mask, x, y)[0] = NAN; // is not above 0
                image_at(&a, x, y)[y % 3] = x % 2 ? INFINITY : NAN;
                continue;
            }
            image_at(&mask, x, y)[(x + y) % 2] = 1e-6f;
            memcpy(image_at(&half_a, x, y), image_at(&a, x, y), 3 * sizeof(float));
            memcpy(image_at(&half_b, x, y), image_at(&b, x, y), 3 * sizeof(float));
        }
    const struct metrics_options options = { .mask = &mask };
    struct metrics masked, half = measure(&half_a, &half_b);
    CHECK(metrics_compute(test_host(), &a, &b, &options, &masked));
    CHECK(masked.counted == 100 && masked.ignored == 0);
    CHECK(masked.mse == half.mse && masked.mae == half.mae && masked.relmse == half.relmse);
    CHECK(memcmp(masked.mean_b, half.mean_b, sizeof half.mean_b) == 0);
    CHECK_NEAR(masked.flip, half.flip, 0.1); // the filters reach beyond the mask
    CHECK(masked.ssim < 1.0 && masked.flip > 0.0);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&mask, test_host());
    image_finish(&half_a, test_host());
    image_finish(&half_b, test_host());
}

TEST(ignored_pixels_are_counted_and_do_not_affect_their_neighbours)
{
    struct image a, b, map;
    struct metrics m;
    const struct metrics_options options = { .ignore_not_finite = true };
    display_image(&b, 30, 20, 3, 1);
    display_image(&a, 30, 20, 3, 1);
    for (int i = 0; i < 4; i++) image_at(&a, 5 + i, 7)[i % 3] = NAN;
    image_at(&b, 8, 7)[1] = INFINITY;
    image_at(&b, 20, 2)[2] = -INFINITY;
    CHECK(metrics_compute(test_host(), &a, &b, &options, &m));
    CHECK(m.ignored == 5 && m.counted == 595);
    CHECK(m.mse == 0.0 && m.ssim == 1.0 && m.flip == 0.0); // equal everywhere else
    CHECK(metrics_error_map(test_host(), &a, &b, &options, METRICS_FLIP, 0.0f, &map));
    for (int i = 0; i < 30 * 20 * 3; i++) CHECK(map.pixels[i] < 1e-6f);
    image_finish(&map, test_host());
    for (int i = 0; i < 30 * 20 * 3; i++) a.pixels[i] = NAN;
    CHECK(!metrics_compute(test_host(), &a, &b, &options, &m));
    CHECK(strstr(test_last_message(), "no pixel is left"));
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(a_mask_of_another_size_or_without_pixels_is_refused)
{
    struct image a, mask, none;
    struct metrics m;
    display_image(&a, 6, 4, 3, 1);
    flat_image(&mask, 4, 6, 1, 1.0f);
    flat_image(&none, 6, 4, 1, 0.0f);
    CHECK(!metrics_compute(test_host(), &a, &a, &(struct metrics_options){ .mask = &mask }, &m));
    CHECK(strstr(test_last_message(), "4x6"));
    CHECK(!metrics_compute(test_host(), &a, &a, &(struct metrics_options){ .mask = &none }, &m));
    CHECK(strstr(test_last_message(), "24 are outside the mask"));
    image_finish(&a, test_host());
    image_finish(&mask, test_host());
    image_finish(&none, test_host());
}

TEST(each_metric_is_the_mean_of_its_map)
{
    struct image a, b, errors;
    struct metrics m;
    const struct metrics_options options = { .radiance = true, .ev = -1.0f };
    display_image(&a, 24, 17, 3, 1);
    display_image(&b, 24, 17, 3, 2);
    CHECK(metrics_compute(test_host(), &a, &b, &options, &m));
    const double expected[] = { m.mae, m.mse, m.relmse, 1.0 - m.ssim, m.flip, m.flip_hdr };
    for (int error = METRICS_ABSOLUTE; error <= METRICS_FLIP_HDR; error++) {
        double sum = 0.0;
        CHECK(metrics_errors(test_host(), &a, &b, &options, (enum metrics_error)error, &errors));
        for (int i = 0; i < 24 * 17; i++) sum += (double)errors.pixels[i];
        CHECK_RELATIVE(sum / (24 * 17), expected[error], 1e-5);
        image_finish(&errors, test_host());
    }
    CHECK(!metrics_errors(test_host(), &a, &b, NULL, METRICS_FLIP_HDR, &errors));
    CHECK(!errors.pixels && strstr(test_last_message(), "radiance"));
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(the_map_of_flip_saturates_at_one)
{
    struct image a, b, automatic, given;
    display_image(&a, 24, 17, 3, 1);
    display_image(&b, 24, 17, 3, 2);
    CHECK(metrics_error_map(test_host(), &a, &b, NULL, METRICS_FLIP, 0.0f, &automatic));
    CHECK(metrics_error_map(test_host(), &a, &b, NULL, METRICS_FLIP, 1.0f, &given));
    CHECK(memcmp(automatic.pixels, given.pixels, 24 * 17 * 3 * sizeof(float)) == 0);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&automatic, test_host());
    image_finish(&given, test_host());
}
