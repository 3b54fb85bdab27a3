#include "test_images.h"

#include "image/png_file.h"
#include "image/ssim.h"

#include <math.h>
#include <string.h>

static void map_of(const struct image *a, const struct image *b, struct image *map)
{
    CHECK(ssim_map(test_host(), a, b, map));
    CHECK(map->width == a->width && map->height == a->height && map->channels == 1);
}

static double mean_of(const struct image *a, const struct image *b)
{
    struct image map;
    double sum = 0.0;
    map_of(a, b, &map);
    size_t pixels = (size_t)map.width * (size_t)map.height;
    for (size_t i = 0; i < pixels; i++) sum += (double)map.pixels[i];
    image_finish(&map, test_host());
    return sum / (double)pixels;
}

static double grey(const struct image *image, int x, int y)
{
    x = x < 0 ? 0 : x >= image->width ? image->width - 1 : x;
    y = y < 0 ? 0 : y >= image->height ? image->height - 1 : y;
    const float *p = image_at(image, x, y);
    double linear = 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

// Twin of the index (eq. 13 with eq. 14 to 16), with a two-dimensional window.
static double twin_ssim(const struct image *a, const struct image *b, int x, int y)
{
    double weight = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (int v = -5; v <= 5; v++)
        for (int u = -5; u <= 5; u++) {
            double w = exp(-(u * u + v * v) / (2 * 1.5 * 1.5));
            double p = grey(a, x + u, y + v), q = grey(b, x + u, y + v);
            weight += w, ma += w * p, mb += w * q;
            aa += w * p * p, bb += w * q * q, ab += w * p * q;
        }
    ma /= weight, mb /= weight;
    aa = aa / weight - ma * ma, bb = bb / weight - mb * mb, ab = ab / weight - ma * mb;
    return (2 * ma * mb + 1e-4) * (2 * ab + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (aa + bb + 9e-4));
}

TEST(the_separable_index_equals_the_twin_at_every_pixel_and_border)
{
    const int sizes[][2] = { { 37, 23 }, { 2, 2 }, { 1, 9 }, { 5, 140 }, { 260, 3 } };
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        struct image a, b, map;
        display_image(&a, sizes[s][0], sizes[s][1], 3, 1);
        display_image(&b, sizes[s][0], sizes[s][1], 3, 2);
        blend(&b, &a, 0.6f);
        map_of(&a, &b, &map);
        for (int y = 0; y < map.height; y++)
            for (int x = 0; x < map.width; x++)
                CHECK_NEAR((double)*image_at(&map, x, y), twin_ssim(&a, &b, x, y), 2e-4);
        image_finish(&a, test_host());
        image_finish(&b, test_host());
        image_finish(&map, test_host());
    }
}

TEST(equal_images_have_a_similarity_of_exactly_one)
{
    struct image a;
    display_image(&a, 40, 31, 3, 5);
    CHECK(mean_of(&a, &a) == 1.0);
    image_finish(&a, test_host());
}

TEST(similarity_is_symmetric_and_never_above_one)
{
    struct image a, b, ab, ba;
    display_image(&a, 40, 31, 3, 5);
    display_image(&b, 40, 31, 4, 6);
    map_of(&a, &b, &ab);
    map_of(&b, &a, &ba);
    CHECK(memcmp(ab.pixels, ba.pixels, 40 * 31 * sizeof(float)) == 0);
    for (int i = 0; i < 40 * 31; i++) CHECK(ab.pixels[i] <= 1.0f && ab.pixels[i] >= -1.0f);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&ab, test_host());
    image_finish(&ba, test_host());
}

TEST(flat_greys_differ_in_luminance_alone)
{
    const float levels[][2] = { { 0.0f, 1.0f }, { 0.2f, 0.3f }, { 0.5f, 0.52f } };
    for (size_t i = 0; i < 3; i++) {
        struct image a, b;
        flat_image(&a, 7, 3, 3, levels[i][0]);
        flat_image(&b, 7, 3, 3, levels[i][1]);
        double p = (double)srgb_encode(levels[i][0]), q = (double)srgb_encode(levels[i][1]);
        CHECK_NEAR(mean_of(&a, &b), (2 * p * q + 1e-4) / (p * p + q * q + 1e-4), 1e-5);
        image_finish(&a, test_host());
        image_finish(&b, test_host());
    }
}

TEST(an_inverted_texture_is_less_similar_than_a_flat_image)
{
    struct image a, b, none;
    flat_image(&a, 32, 32, 3, 0.0f);
    flat_image(&b, 32, 32, 3, 0.0f);
    flat_image(&none, 32, 32, 3, srgb_decode(0.5f));
    for (int i = 0; i < 32 * 32 * 3; i++) {
        int x = i / 3 % 32, y = i / 96;
        a.pixels[i] = srgb_decode((x + y) % 2 ? 0.7f : 0.3f);
        b.pixels[i] = srgb_decode((x + y) % 2 ? 0.3f : 0.7f);
    }
    CHECK(mean_of(&b, &a) < -0.9);
    CHECK_NEAR(mean_of(&none, &a), 0.0, 0.05);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    image_finish(&none, test_host());
}

TEST(more_noise_is_less_similar)
{
    struct image a, noise;
    display_image(&a, 48, 32, 3, 1);
    double last = 1.0;
    for (int step = 1; step <= 4; step++) {
        display_image(&noise, 48, 32, 3, 9);
        blend(&noise, &a, 1.0f - 0.2f * (float)step);
        double now = mean_of(&noise, &a);
        CHECK(now < last - 0.01);
        last = now;
        image_finish(&noise, test_host());
    }
    image_finish(&a, test_host());
}
