// Automatic exposure of images. A bin of the histogram is at most 1/64 wide, relative to its
// luminances, so single luminances are exposed within 1/128.
#include "test_images.h"

#include "image/exposure.h"
#include "image/tonemap.h"

#include <math.h>

static const double BIN = 1.0 / 128;

TEST(a_grey_card_becomes_middle_grey)
{
    for (int i = -40; i <= 40; i++) {
        struct image image;
        float radiance = exp2f((float)i * 0.77f);
        flat_image(&image, 6, 4, 3, radiance);
        float exposed = radiance * exposure_scale(auto_exposure(&image, METERING_MEAN));
        CHECK_RELATIVE((double)exposed, 0.18, BIN);
        image_finish(&image, test_host());
    }
}

TEST(eight_times_the_radiance_gains_exactly_three_stops)
{
    struct image image;
    noise_image(&image, 160, 99, 3);
    float ev = auto_exposure(&image, METERING_MEAN);
    for (int i = 0; i < 160 * 99 * 3; i++) image.pixels[i] *= 8.0f;
    CHECK(auto_exposure(&image, METERING_MEAN) == ev + 3.0f);
    image_finish(&image, test_host());
}

static void fill_columns(struct image *image, int begin, int end, float radiance)
{
    for (int y = 0; y < image->height; y++)
        for (int x = begin; x < end; x++)
            for (int c = 0; c < 3; c++) image_at(image, x, y)[c] = radiance;
}

TEST(two_greys_are_exposed_for_their_geometric_mean)
{
    struct image image;
    flat_image(&image, 4, 4, 3, 2.0f);
    fill_columns(&image, 0, 2, 8.0f);
    CHECK_RELATIVE(4.0 * (double)exposure_scale(auto_exposure(&image, METERING_MEAN)), 0.18, BIN);
    image_finish(&image, test_host());
}

// Lamps and deep shadows of less than a tenth of the image have no effect, however bright or dark.
TEST(extremes_of_a_few_pixels_do_not_count)
{
    struct image image;
    flat_image(&image, 100, 10, 3, 1.0f);
    float ev = auto_exposure(&image, METERING_MEAN);
    fill_columns(&image, 0, 8, 1e9f);
    fill_columns(&image, 8, 16, 1e-9f);
    CHECK(auto_exposure(&image, METERING_MEAN) == ev);
    fill_columns(&image, 0, 16, 1e9f); // an eighth: the percentile lies in it
    CHECK(auto_exposure(&image, METERING_MEAN) > ev + 3.0f);
    image_finish(&image, test_host());
}

static double exposed(const struct image *image, float radiance, enum exposure_metering metering)
{
    return (double)radiance * (double)exposure_scale(auto_exposure(image, metering));
}

// A sunlit patch of a twentieth of the floor: by the mean it is far above 1.
TEST(highlights_are_exposed_to_one)
{
    struct image image;
    flat_image(&image, 100, 10, 3, 10.0f);
    fill_columns(&image, 0, 5, 300.0f);
    CHECK_RELATIVE(exposed(&image, 10.0f, METERING_MEAN), 0.18, BIN);
    CHECK_RELATIVE(exposed(&image, 300.0f, METERING_HIGHLIGHTS), 1.0, BIN);
    image_finish(&image, test_host());
}

TEST(highlights_cost_three_stops_at_most)
{
    struct image image;
    flat_image(&image, 100, 10, 3, 10.0f);
    fill_columns(&image, 0, 5, 1e6f);
    CHECK_RELATIVE(exposed(&image, 10.0f, METERING_HIGHLIGHTS), 0.18 / 8, BIN);
    image_finish(&image, test_host());
}

// Without bright parts, or with a few bright pixels, both rules agree.
TEST(images_without_highlights_keep_their_exposure)
{
    struct image image;
    flat_image(&image, 100, 10, 3, 1.0f);
    fill_columns(&image, 0, 50, 4.0f);
    CHECK(auto_exposure(&image, METERING_HIGHLIGHTS) == auto_exposure(&image, METERING_MEAN));
    fill_columns(&image, 0, 1, 1e6f);
    CHECK(auto_exposure(&image, METERING_HIGHLIGHTS) == auto_exposure(&image, METERING_MEAN));
    image_finish(&image, test_host());
}

// The lit part of an image that is black otherwise keeps its colours.
TEST(a_lit_patch_among_black_is_exposed_to_middle_grey)
{
    struct image image;
    flat_image(&image, 100, 4, 3, 0.0f);
    for (int lit = 1; lit <= 100; lit++) {
        fill_columns(&image, 0, lit, 1000.0f);
        double ev = (double)auto_exposure(&image, METERING_MEAN);
        CHECK_RELATIVE(1000.0 * (double)exposure_scale((float)ev), 0.18, BIN);
    }
    image_finish(&image, test_host());
}

TEST(pixels_without_alpha_do_not_count)
{
    struct image image;
    CHECK(image_init(&image, test_host(), 10, 10, 4));
    for (int i = 0; i < 100; i++)
        for (int c = 0; c < 4; c++) image.pixels[4 * i + c] = i < 80 ? (c < 3) * 1e6f : 1.0f;
    CHECK_RELATIVE((double)exposure_scale(auto_exposure(&image, METERING_MEAN)), 0.18, BIN);
    image_finish(&image, test_host());
}

TEST(a_black_image_has_exposure_zero)
{
    struct image image;
    flat_image(&image, 5, 5, 3, 0.0f);
    CHECK(auto_exposure(&image, METERING_MEAN) == 0.0f);
    image_at(&image, 2, 2)[1] = -1.0f;
    image_at(&image, 3, 2)[1] = NAN; // counts as black
    CHECK(auto_exposure(&image, METERING_MEAN) == 0.0f);
    image_finish(&image, test_host());
}

TEST(the_grid_covers_every_size)
{
    static const uint32_t sizes[][2] = { { 1, 1 },     { 128, 128 }, { 129, 128 },
                                         { 640, 360 }, { 3, 16384 }, { 16384, 16384 } };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint32_t w = sizes[i][0], h = sizes[i][1], s = exposure_stride(w, h);
        uint64_t cells = (uint64_t)((w + s - 1) / s) * ((h + s - 1) / s);
        CHECK(cells <= 16384 && (s == 1 || cells > 3000));
    }
    struct image image;
    flat_image(&image, 3, 16384, 3, 1.0f);
    CHECK_RELATIVE((double)exposure_scale(auto_exposure(&image, METERING_MEAN)), 0.18, BIN);
    image_finish(&image, test_host());
}
