#include "test_images.h"

#include "image/png_file.h"

#include "core/files/file.h"

#include <png.h>

#include <math.h>
#include <string.h>

TEST(the_srgb_curve_and_its_inverse_agree)
{
    for (int i = -10; i <= 1010; i++) {
        float encoded = (float)i / 1000.0f;
        CHECK_NEAR((double)srgb_encode(srgb_decode(encoded)), (double)encoded, 2e-6);
    }
    // IEC 61966-2-1
    CHECK_NEAR((double)srgb_encode(0.5f), 0.735357, 1e-5);
    CHECK_NEAR((double)srgb_encode(0.18f), 0.461356, 1e-5);
    CHECK_NEAR((double)srgb_encode(0.002f), 0.02584, 1e-6);
    CHECK_NEAR((double)srgb_decode(0.5f), 0.214041, 1e-5);
    CHECK_NEAR((double)srgb_encode(1.0f), 1.0, 1e-6);
    CHECK(srgb_encode(0.0f) == 0.0f);
}

TEST(an_image_round_trips_within_half_a_code)
{
    for (int channels = 1; channels <= 4; channels++) {
        struct image image, back;
        CHECK(image_init(&image, test_host(), 64, 48, channels == 2 ? 3 : channels));
        for (int i = 0; i < 64 * 48 * image.channels; i++)
            image.pixels[i] = (float)((i * 7919) % 10007) / 10006.0f;
        const char *path = test_path("round.png");
        CHECK(png_write(test_host(), path, &image));
        CHECK(png_read(test_host(), path, &back));
        CHECK(back.width == 64 && back.height == 48);
        CHECK(back.channels == (image.channels == 4 ? 4 : 3));
        for (int i = 0; i < 64 * 48; i++) {
            for (int c = 0; c < back.channels; c++) {
                float a = image.pixels[i * image.channels + (image.channels == 1 ? 0 : c)],
                      b = back.pixels[i * back.channels + c];
                bool is_alpha = c == 3;
                double difference =
                    is_alpha ? (double)(a - b) : (double)(srgb_encode(a) - srgb_encode(b));
                CHECK(fabs(difference) <= 0.5 / 255 + 1e-5);
            }
        }
        image_finish(&image, test_host());
        image_finish(&back, test_host());
    }
}

TEST(all_codes_round_trip_exactly)
{
    struct image image, back;
    CHECK(image_init(&image, test_host(), 256, 1, 3));
    for (int i = 0; i < 256 * 3; i++) image.pixels[i] = srgb_decode((float)(i / 3) / 255.0f);
    const char *path = test_path("codes.png");
    CHECK(png_write(test_host(), path, &image));
    CHECK(png_read(test_host(), path, &back));
    CHECK(memcmp(image.pixels, back.pixels, 256 * 3 * sizeof(float)) == 0);
    image_finish(&image, test_host());
    image_finish(&back, test_host());
}

TEST(values_outside_the_display_range_are_clamped_and_nan_is_black)
{
    struct image image, back;
    CHECK(image_init(&image, test_host(), 4, 1, 3));
    static const float values[4] = { -1.0f, 7.0f, NAN, INFINITY };
    static const float expected[4] = { 0.0f, 1.0f, 0.0f, 1.0f };
    for (int i = 0; i < 12; i++) image.pixels[i] = values[i / 3];
    const char *path = test_path("clamped.png");
    CHECK(png_write(test_host(), path, &image));
    CHECK(png_read(test_host(), path, &back));
    for (int i = 0; i < 12; i++) CHECK_NEAR((double)back.pixels[i], (double)expected[i / 3], 1e-6);
    image_finish(&image, test_host());
    image_finish(&back, test_host());
}

TEST(two_channels_and_unwritable_paths_are_refused)
{
    struct image image;
    flat_image(&image, 2, 2, 2, 0.5f);
    CHECK(!png_write(test_host(), test_path("two.png"), &image));
    CHECK(strstr(test_last_message(), "not 2"));
    image_finish(&image, test_host());
    flat_image(&image, 2, 2, 3, 0.5f);
    CHECK(!png_write(test_host(), "/nowhere/out.png", &image));
    CHECK(strstr(test_last_message(), "/nowhere/out.png"));
    image_finish(&image, test_host());
}

TEST(the_same_image_gives_the_same_bytes)
{
    struct image image;
    struct file_bytes a, b;
    noise_image(&image, 32, 20, 3);
    CHECK(png_write(test_host(), test_path("a.png"), &image));
    CHECK(png_write(test_host(), test_path("b.png"), &image));
    CHECK(file_read(test_host(), test_path("a.png"), 0, &a));
    CHECK(file_read(test_host(), test_path("b.png"), 0, &b));
    CHECK(a.size == b.size && memcmp(a.data, b.data, a.size) == 0);
    file_bytes_finish(test_host(), &a);
    file_bytes_finish(test_host(), &b);
    image_finish(&image, test_host());
}

// A file of another program: `bits` per channel, interlaced or not, samples in ascending order.
static void write_foreign(const char *path, int colour_type, int bits, int interlace)
{
    enum { W = 9, H = 7 };
    FILE *stream = fopen(path, "wb");
    CHECK(stream);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, W, H, bits, colour_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_color palette[4] = { { 0, 0, 0 }, { 255, 0, 0 }, { 0, 255, 0 }, { 255, 255, 255 } };
    png_byte transparency[4] = { 0, 255, 255, 255 };
    if (colour_type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, info, palette, 4);
        png_set_tRNS(png, info, transparency, 4, NULL);
    }
    png_write_info(png, info);
    static png_byte rows[H][W * 8];
    png_bytep pointers[H];
    for (int y = 0; y < H; y++) {
        for (int i = 0; i < W * 8; i++)
            rows[y][i] = (png_byte)(colour_type == PNG_COLOR_TYPE_PALETTE ? 0x1b : y * 31 + i);
        pointers[y] = rows[y];
    }
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(stream);
}

static void read_foreign(int colour_type, int bits, int interlace, struct image *out)
{
    const char *path = test_path("foreign.png");
    write_foreign(path, colour_type, bits, interlace);
    CHECK(png_read(test_host(), path, out));
    CHECK(out->width == 9 && out->height == 7);
}

TEST(every_colour_type_and_depth_is_read)
{
    struct image image;
    read_foreign(PNG_COLOR_TYPE_GRAY, 1, PNG_INTERLACE_NONE, &image);
    CHECK(image.channels == 3);
    for (int x = 0; x < 8; x++) // row 1 begins with the bits of 31
        CHECK_NEAR((double)image_at(&image, x, 1)[1], x < 3 ? 0.0 : 1.0, 1e-6);
    image_finish(&image, test_host());

    read_foreign(PNG_COLOR_TYPE_PALETTE, 2, PNG_INTERLACE_NONE, &image); // entries 0 1 2 3 0 1 …
    CHECK(image.channels == 4);
    CHECK(image_at(&image, 0, 0)[3] == 0.0f && image_at(&image, 1, 0)[3] == 1.0f);
    CHECK(image_at(&image, 1, 0)[0] == 1.0f && image_at(&image, 1, 0)[1] == 0.0f);
    CHECK(image_at(&image, 2, 6)[1] == 1.0f && image_at(&image, 2, 6)[0] == 0.0f);
    image_finish(&image, test_host());

    read_foreign(PNG_COLOR_TYPE_GRAY_ALPHA, 8, PNG_INTERLACE_NONE, &image);
    CHECK(image.channels == 4);
    CHECK_NEAR((double)image_at(&image, 3, 2)[3], (62 + 7) / 255.0, 1e-6); // alpha is not a colour
    CHECK_NEAR((double)image_at(&image, 3, 2)[2], (double)srgb_decode(68 / 255.0f), 1e-6);
    image_finish(&image, test_host());

    read_foreign(PNG_COLOR_TYPE_RGB, 16, PNG_INTERLACE_NONE, &image);
    CHECK(image.channels == 3);
    double sample = ((62 + 4) * 256 + 62 + 5) / 65535.0; // the third sample of row 2
    CHECK_NEAR((double)image_at(&image, 0, 2)[2], (double)srgb_decode((float)sample), 1e-6);
    image_finish(&image, test_host());
}

TEST(an_interlaced_file_gives_the_same_image)
{
    struct image plain, interlaced;
    read_foreign(PNG_COLOR_TYPE_RGB_ALPHA, 8, PNG_INTERLACE_NONE, &plain);
    read_foreign(PNG_COLOR_TYPE_RGB_ALPHA, 8, PNG_INTERLACE_ADAM7, &interlaced);
    CHECK(memcmp(plain.pixels, interlaced.pixels, 9 * 7 * 4 * sizeof(float)) == 0);
    image_finish(&plain, test_host());
    image_finish(&interlaced, test_host());
}

static size_t largest; // block asked for

static void *record_largest(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes > largest) largest = bytes;
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

// A file of 57 bytes claimed a text of 64 MB, which was allocated and cleared.
TEST(ancillary_chunks_are_not_read)
{
    static const uint8_t start[] = { 0x89, 'P', 'N',  'G',  '\r', '\n', 0x1a, '\n', 0,
                                     0,    0,   13,   'I',  'H',  'D',  'R',  0,    0,
                                     0,    1,   0,    0,    0,    1,    8,    0,    0,
                                     0,    0,   0x3a, 0x7e, 0x9b, 0x55, 0x03, 0xff, 0xff,
                                     0xf0, 'z', 'T',  'X',  't',  'a',  0,    0,    'x' };
    struct host host = { .reallocate = record_largest };
    const char *path = test_path("text.png");
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(start, sizeof start, 1, file) == 1 && fclose(file) == 0);
    struct image image;
    largest = 0;
    CHECK(!png_read(&host, path, &image));
    CHECK(largest > 0 && largest < 1 << 20);
}
