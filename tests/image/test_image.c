#include "test_images.h"

#include <string.h>

TEST(image_init_gives_zeroed_pixels)
{
    struct image image;
    CHECK(image_init(&image, test_host(), 7, 3, 4));
    for (int i = 0; i < 7 * 3 * 4; i++) CHECK(image.pixels[i] == 0.0f);
    image_finish(&image, test_host());
    CHECK(!image.pixels);
    image_finish(&image, test_host()); // accepts a zeroed image
}

TEST(image_init_refuses_sizes_outside_its_bounds)
{
    static const int bad[][3] = { { 0, 1, 3 },
                                  { 1, 0, 3 },
                                  { -5, 4, 3 },
                                  { 1, 1, 0 },
                                  { 1, 1, 5 },
                                  { IMAGE_MAX_SIZE + 1, 1, 1 },
                                  { 1, IMAGE_MAX_SIZE + 1, 1 } };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct image image;
        CHECK(!image_init(&image, test_host(), bad[i][0], bad[i][1], bad[i][2]));
        CHECK(!image.pixels);
        CHECK(test_host()->failure == FAIL_ARGUMENT);
    }
    struct image widest;
    CHECK(image_init(&widest, test_host(), IMAGE_MAX_SIZE, 1, 1));
    image_finish(&widest, test_host());
}

TEST(image_at_addresses_rows_from_the_top_with_interleaved_channels)
{
    struct image image;
    CHECK(image_init(&image, test_host(), 5, 4, 3));
    CHECK(image_at(&image, 0, 0) == image.pixels);
    CHECK(image_at(&image, 1, 0) == image.pixels + 3);
    CHECK(image_at(&image, 2, 3) == image.pixels + (3 * 5 + 2) * 3);
    image_finish(&image, test_host());
}

TEST(image_side_by_side_copies_both_with_a_black_gap)
{
    struct image a, b, both;
    noise_image(&a, 3, 2, 3);
    noise_image(&b, 5, 2, 3);
    CHECK(image_side_by_side(&both, test_host(), &a, &b, 2));
    CHECK(both.width == 10 && both.height == 2 && both.channels == 3);
    for (int y = 0; y < 2; y++) {
        for (int x = 0; x < 10; x++) {
            for (int c = 0; c < 3; c++) {
                float expected = x < 3   ? image_at(&a, x, y)[c]
                                 : x < 5 ? 0.0f
                                         : image_at(&b, x - 5, y)[c];
                CHECK(image_at(&both, x, y)[c] == expected);
            }
        }
    }
    image_finish(&both, test_host());
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(image_side_by_side_reports_both_sizes_on_a_mismatch)
{
    struct image a, b, both;
    flat_image(&a, 3, 2, 3, 0.0f);
    flat_image(&b, 3, 4, 3, 0.0f);
    CHECK(!image_side_by_side(&both, test_host(), &a, &b, 0));
    CHECK(strstr(test_last_message(), "3x2") && strstr(test_last_message(), "3x4"));
    CHECK(!image_side_by_side(&both, test_host(), &a, &a, -1));
    CHECK(!image_side_by_side(&both, test_host(), &a, &a, IMAGE_MAX_SIZE));
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}
