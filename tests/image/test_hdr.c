// Radiance images: encoders of the test write each form by hand, from the format's description.
#include "framework/test.h"

#include "image/hdr.h"

#include "core/files/file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FLAT, OLD_RLE, NEW_RLE, ENCODINGS };

struct bytes {
    uint8_t *data;
    size_t size, capacity;
};

static void put(struct bytes *out, const void *data, size_t size)
{
    if (out->size + size > out->capacity) {
        out->capacity = 2 * (out->size + size);
        out->data = realloc(out->data, out->capacity);
        CHECK(out->data);
    }
    if (size > 0) memcpy(out->data + out->size, data, size);
    out->size += size;
}

static void put_text(struct bytes *out, const char *text)
{
    put(out, text, strlen(text));
}

static void put_byte(struct bytes *out, int value)
{
    put(out, &(uint8_t){ (uint8_t)value }, 1);
}

static void finish(struct bytes *bytes)
{
    free(bytes->data);
    *bytes = (struct bytes){ 0 };
}

// Ward 1991: the common exponent is that of the largest component; mantissas are truncated.
static void rgbe_of(const float rgb[3], uint8_t out[4])
{
    const float largest = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    int exponent;
    memset(out, 0, 4);
    if (largest < 1e-32f) return;
    frexpf(largest, &exponent);
    for (int c = 0; c < 3; c++) out[c] = (uint8_t)ldexpf(rgb[c], 8 - exponent);
    out[3] = (uint8_t)(exponent + 128);
}

static double step_of(const uint8_t rgbe[4])
{
    return rgbe[3] ? ldexp(1.0, rgbe[3] - 136) : 0.0;
}

static void put_old_line(struct bytes *out, const uint8_t *rgbe, int width, bool runs)
{
    for (int x = 0; x < width;) {
        int same = 0;
        put(out, rgbe + 4 * x, 4);
        while (runs && x + 1 + same < width &&
               memcmp(rgbe + 4 * x, rgbe + 4 * (x + 1 + same), 4) == 0)
            same++;
        for (int left = same; left > 0; left >>= 8) // the lowest bits first
            put(out, &(uint8_t[]){ 1, 1, 1, (uint8_t)left }, 4);
        x += 1 + same;
    }
}

static void put_channel(struct bytes *out, const uint8_t *values, int width)
{
    for (int x = 0; x < width;) {
        int same = 1, different = 1;
        while (x + same < width && same < 127 && values[4 * (x + same)] == values[4 * x]) same++;
        if (same > 2) {
            put_byte(out, 128 + same), put_byte(out, values[4 * x]);
            x += same;
            continue;
        }
        while (x + different < width && different < 128 &&
               values[4 * (x + different)] != values[4 * (x + different - 1)])
            different++;
        put_byte(out, different);
        for (int i = 0; i < different; i++) put_byte(out, values[4 * (x + i)]);
        x += different;
    }
}

static void put_new_line(struct bytes *out, const uint8_t *rgbe, int width)
{
    put(out, &(uint8_t[]){ 2, 2, (uint8_t)(width >> 8), (uint8_t)(width & 255) }, 4);
    for (int c = 0; c < 4; c++) put_channel(out, rgbe + c, width);
}

static void put_header(struct bytes *out, int width, int height, const char *variables)
{
    char text[100];
    put_text(out, "#?RADIANCE\n# made by a test\n");
    put_text(out, variables);
    snprintf(text, sizeof text, "FORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height, width);
    put_text(out, text);
}

// Smooth, with runs of equal pixels, black ones and ten decades.
static void make_rgbe(uint8_t *rgbe, float *rgb, int width, int height)
{
    for (int i = 0; i < width * height; i++) {
        const int place = i / 5 % 3 == 0 ? i / 5 : i;
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] =
                place % 11 == 4 ? 0.0f : powf(10.0f, (float)(place * (c + 3) % 101) / 10.0f - 5.0f);
        rgbe_of(rgb + 3 * i, rgbe + 4 * i);
    }
}

static void put_lines(struct bytes *out, const uint8_t *rgbe, int width, int height, int encoding)
{
    for (int y = 0; y < height; y++, rgbe += 4 * width)
        if (encoding == NEW_RLE)
            put_new_line(out, rgbe, width);
        else
            put_old_line(out, rgbe, width, encoding == OLD_RLE);
}

static bool decode(const struct bytes *bytes, struct image *out)
{
    test_forget_messages();
    test_host()->failure = FAIL_NONE;
    return hdr_decode(test_host(), "sky.hdr", bytes->data, bytes->size, out);
}

static void check_refused(const struct bytes *bytes, enum fail_kind kind, const char *why)
{
    struct image image;
    CHECK(!decode(bytes, &image));
    CHECK(!image.pixels && image.width == 0);
    CHECK(strncmp(test_last_message(), "cannot read sky.hdr: ", 21) == 0);
    if (!strstr(test_last_message(), why)) fail_msg("%s: no '%s'", test_last_message(), why);
    CHECK(test_host()->failure == kind);
}

static void check_size(int width, int height, int encoding)
{
    const size_t pixels = (size_t)width * (size_t)height;
    uint8_t *rgbe = malloc(pixels * 4);
    float *rgb = malloc(pixels * 3 * sizeof *rgb);
    struct bytes bytes = { 0 };
    struct image image;
    CHECK(rgbe && rgb);
    make_rgbe(rgbe, rgb, width, height);
    put_header(&bytes, width, height, "");
    put_lines(&bytes, rgbe, width, height, encoding);
    CHECK(decode(&bytes, &image));
    CHECK(image.width == width && image.height == height && image.channels == 3);
    for (size_t i = 0; i < pixels * 3; i++)
        CHECK_NEAR(image.pixels[i], rgb[i], 0.5001 * step_of(rgbe + i / 3 * 4));
    image_finish(&image, test_host());
    finish(&bytes);
    free(rgb), free(rgbe);
}

TEST(every_encoding_gives_the_values_to_half_a_step_of_the_mantissa)
{
    static const int sizes[][2] = { { 1, 1 }, { 7, 3 }, { 8, 1 }, { 13, 5 }, { 1, 9 }, { 331, 3 } };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int encoding = 0; encoding < ENCODINGS; encoding++)
            if (encoding != NEW_RLE || sizes[i][0] >= 8)
                check_size(sizes[i][0], sizes[i][1], encoding);
}

// One pixel and runs of 300 others, in 8-bit pieces.
TEST(counts_of_consecutive_old_runs_are_digits_of_base_256)
{
    const uint8_t pixel[4] = { 128, 64, 32, 129 };
    static uint8_t rgbe[16384 * 4];
    struct bytes bytes = { 0 };
    struct image image;
    for (int x = 0; x < 16384; x++) memcpy(rgbe + 4 * x, pixel, 4);
    put_header(&bytes, 16384, 2, "");
    for (int y = 0; y < 2; y++) put_old_line(&bytes, rgbe, 16384, true);
    CHECK(bytes.size < 200);
    CHECK(decode(&bytes, &image));
    CHECK_NEAR(image_at(&image, 16383, 1)[0], 1.0, 0.005);
    CHECK_NEAR(image_at(&image, 299, 0)[2], 0.25, 0.005);
    image_finish(&image, test_host());
    finish(&bytes);
}

// Neither is part of a run or of the new encoding.
TEST(a_line_below_eight_pixels_is_flat_though_it_begins_with_2_2)
{
    const uint8_t line[7][4] = { { 2, 2, 0, 135 } };
    struct bytes bytes = { 0 };
    struct image image;
    put_header(&bytes, 7, 1, "");
    put(&bytes, line, sizeof line);
    CHECK(decode(&bytes, &image));
    CHECK_NEAR(image.pixels[0], 1.25, 1e-6);
    CHECK(image.pixels[3] == 0.0f);
    image_finish(&image, test_host());
    finish(&bytes);
}

static float decode_one(const char *header)
{
    struct bytes bytes = { 0 };
    struct image image;
    put_text(&bytes, header);
    put(&bytes, &(uint8_t[]){ 128, 64, 255, 129 }, 4); // 1, 0.5, 2
    if (!decode(&bytes, &image)) fail_msg("%s", test_last_message());
    const float red = image.pixels[0];
    image_finish(&image, test_host());
    finish(&bytes);
    return red;
}

TEST(exposures_are_divided_out)
{
    const double one = 1.00390625; // 128.5 / 128
    CHECK_RELATIVE(decode_one("#?RADIANCE\n\n-Y 1 +X 1\n"), one, 1e-6);
    CHECK_RELATIVE(decode_one("#?RGBE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n"), one, 1e-6);
    CHECK_RELATIVE(decode_one("#?RADIANCE\nEXPOSURE=4\n\n-Y 1 +X 1\n"), one / 4, 1e-6);
    CHECK_RELATIVE(decode_one("#?RADIANCE\nEXPOSURE= 2.5e-1 \nEXPOSURE=+16.\n\n-Y 1 +X 1\n"),
                   one / 4, 1e-6);
    CHECK_RELATIVE(decode_one("#?RADIANCE\nEXPOSURE=.125E+2\n\n-Y 1 +X 1\n"), one / 12.5, 1e-6);
    CHECK(isfinite(decode_one("#?RADIANCE\nEXPOSURE=1e-300\n\n-Y 1 +X 1\n")));
}

static void check_header(const char *header, enum fail_kind kind, const char *why)
{
    struct bytes bytes = { 0 };
    put_text(&bytes, header);
    put(&bytes, &(uint8_t[]){ 128, 64, 255, 129 }, 4);
    check_refused(&bytes, kind, why);
    finish(&bytes);
}

TEST(headers_that_cannot_be_used_are_refused_by_name)
{
#define HEAD "#?RADIANCE\n"
    check_header("", FAIL_FORMAT, "not a Radiance image");
    check_header("P6\n1 1\n255\n", FAIL_FORMAT, "not a Radiance image");
    check_header(HEAD "FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", FAIL_UNSUPPORTED, "xyze");
    check_header(HEAD "FORMAT=text\n\n-Y 1 +X 1\n", FAIL_FORMAT, "FORMAT");
    static const char *const exposures[] = { "0", "-1",    "nan",   "inf",
                                             "",  "1x",    "1e999", "1e-99999999999",
                                             ".", "0x1p3", "1e" };
    for (size_t i = 0; i < sizeof exposures / sizeof *exposures; i++) {
        char header[100];
        snprintf(header, sizeof header, HEAD "EXPOSURE=%s\n\n-Y 1 +X 1\n", exposures[i]);
        check_header(header, FAIL_FORMAT, "EXPOSURE");
    }
    check_header(HEAD "EXPOSURE=1e200\nEXPOSURE=1e200\n\n-Y 1 +X 1\n", FAIL_FORMAT, "product");
    check_header(HEAD "\n+Y 1 +X 1\n", FAIL_UNSUPPORTED, "orientation is +Y +X");
    check_header(HEAD "\n-Y 1 -X 1\n", FAIL_UNSUPPORTED, "orientation is -Y -X");
    check_header(HEAD "\n+X 1 -Y 1\n", FAIL_UNSUPPORTED, "orientation is +X -Y");
    static const char *const resolutions[] = { "",           "-Y",         "-Y 1",
                                               "-Y 1 +X",    "-Y 1 +X ",   "-Y 1 +Y 1",
                                               "-X 1 +X 1",  "-Y -1 +X 1", "-Y 1 +X 1 ",
                                               "-Y 1  +X 1", "-Y 1.5 +X 1" };
    for (size_t i = 0; i < sizeof resolutions / sizeof *resolutions; i++) {
        char header[100];
        snprintf(header, sizeof header, HEAD "\n%s\n", resolutions[i]);
        check_header(header, FAIL_FORMAT, "resolution line");
    }
}

TEST(sizes_beyond_the_limit_are_refused)
{
    check_header(HEAD "\n-Y 1 +X 40000\n", FAIL_FORMAT, "-Y 1 +X 40000");
    check_header(HEAD "\n-Y 16385 +X 1\n", FAIL_FORMAT, "1 to 16384");
    check_header(HEAD "\n-Y 0 +X 1\n", FAIL_FORMAT, "1 to 16384");
    check_header(HEAD "\n-Y 1 +X 0\n", FAIL_FORMAT, "1 to 16384");
    check_header(HEAD "\n-Y 99999999999999999999 +X 4294967297\n", FAIL_FORMAT, "1 to 16384");
}

static size_t most_bytes;

static void *counting_reallocate(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes > most_bytes) most_bytes = bytes;
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

TEST(a_short_file_with_a_large_header_allocates_no_image)
{
    static const char header[] = HEAD "\n-Y 16384 +X 16384\n\x02\x02\x40\x00\xff\xff\xff\xff";
    struct host host = { .reallocate = counting_reallocate };
    struct image image;
    most_bytes = 0;
    CHECK(!hdr_decode(&host, "large.hdr", header, sizeof header - 1, &image));
    CHECK(host.failure == FAIL_FORMAT && !image.pixels);
    CHECK(most_bytes <= 4 * IMAGE_MAX_SIZE);
}

TEST(a_file_cut_at_any_byte_is_refused)
{
    enum { WIDTH = 37, HEIGHT = 4 };
    uint8_t rgbe[WIDTH * HEIGHT * 4];
    float rgb[WIDTH * HEIGHT * 3];
    make_rgbe(rgbe, rgb, WIDTH, HEIGHT);
    for (int encoding = 0; encoding < ENCODINGS; encoding++) {
        struct bytes bytes = { 0 };
        put_header(&bytes, WIDTH, HEIGHT, "EXPOSURE=2\n");
        put_lines(&bytes, rgbe, WIDTH, HEIGHT, encoding);
        for (size_t size = 0; size < bytes.size; size++) {
            struct bytes cut = { 0 }; // its own block, so that sanitizers find reads beyond
            put(&cut, bytes.data, size);
            cut.data = realloc(cut.data, size ? size : 1);
            check_refused(&cut, FAIL_FORMAT, "");
            finish(&cut);
        }
        finish(&bytes);
    }
}

static void check_line(int width, const void *line, size_t size, const char *why)
{
    struct bytes bytes = { 0 };
    put_header(&bytes, width, 1, "");
    put(&bytes, line, size);
    put(&bytes, &(uint8_t[400]){ 0 }, 400);
    check_refused(&bytes, FAIL_FORMAT, why);
    CHECK(strstr(test_last_message(), "row 0"));
    finish(&bytes);
}

TEST(runs_that_exceed_their_line_are_refused)
{
    const uint8_t old_first[] = { 1, 1, 1, 2 };
    const uint8_t old_long[] = { 128, 128, 128, 128, 1, 1, 1, 9 };
    const uint8_t old_shift[] = { 128, 128, 128, 128, 1, 1, 1, 0, 1, 1, 1, 1 };
    const uint8_t old_endless[] = { 128, 128, 128, 128, 1, 1, 1, 0, 1, 1, 1, 0,
                                    1,   1,   1,   0,   1, 1, 1, 0, 1, 1, 1, 0 };
    check_line(9, old_first, sizeof old_first, "begins with a run");
    check_line(9, old_long, sizeof old_long, "a run exceeds");
    check_line(9, old_shift, sizeof old_shift, "a run exceeds");
    check_line(9, old_endless, sizeof old_endless, "a run exceeds");
    const uint8_t new_run[] = { 2, 2, 0, 9, 128 + 10, 1 };
    const uint8_t new_literals[] = { 2, 2, 0, 9, 128 + 8, 1, 2, 1, 1 };
    const uint8_t new_empty[] = { 2, 2, 0, 9, 0, 0 };
    const uint8_t new_width[] = { 2, 2, 0, 10, 128 + 9, 1 };
    check_line(9, new_run, sizeof new_run, "a run exceeds");
    check_line(9, new_literals, sizeof new_literals, "a run exceeds");
    check_line(9, new_empty, sizeof new_empty, "an empty run");
    check_line(9, new_width, sizeof new_width, "another width");
}

TEST(files_are_read_and_named_in_messages)
{
    const char *path = test_path("one.hdr");
    struct image image;
    FILE *stream = fopen(path, "wb");
    CHECK(stream);
    CHECK(fputs(HEAD "\n-Y 1 +X 1\n\x80\x80\x80\x81", stream) >= 0 && fclose(stream) == 0);
    CHECK(hdr_read(test_host(), path, &image));
    CHECK_NEAR(image.pixels[2], 1.0, 0.005);
    image_finish(&image, test_host());
    CHECK(!hdr_read(test_host(), "/nowhere/one.hdr", &image));
    CHECK(!image.pixels && test_host()->failure == FAIL_FILE);
    CHECK(strstr(test_last_message(), "/nowhere/one.hdr"));
}
