// Image decoding of untrusted data: every form of PNG to the bit, JPEG within its loss, and what is
// refused.
#include "framework/test.h"

#include "core/files/file.h"
#include "scene/images/image_decode.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

static char reason[DECODE_WHY_SIZE];

static const char *size_of(struct file_bytes file, int *width, int *height)
{
    return image_decode_size(file.data, file.size, width, height, reason);
}

// NULL, or why it failed; *rgba is to be freed.
static const char *decode(struct file_bytes file, int *width, int *height, uint8_t **rgba)
{
    const char *why = size_of(file, width, height);
    *rgba = NULL;
    if (why) return why;
    *rgba = malloc((size_t)*width * (size_t)*height * 4);
    CHECK(*rgba);
    return image_decode(file.data, file.size, *width, *height, *rgba, reason);
}

static void check_refused(struct file_bytes file, const char *expected)
{
    int width, height;
    uint8_t *rgba;
    const char *why = decode(file, &width, &height, &rgba);
    free(rgba);
    if (!why) fail_msg("not refused: %s", expected);
    if (!strstr(why, expected)) fail_msg("%s, not %s", why, expected);
}

// ---- PNG

enum { W = 9, H = 7 }; // beyond the first block of all passes of an interlaced file

struct form {
    int colour_type, bits, interlace;
    bool transparent; // has a chunk tRNS
};

// Sample c of a pixel, in the bits of the form.
static unsigned sample_of(const struct form *form, int x, int y, int c)
{
    return (unsigned)(x * 4099 + y * 1031 + c * 523 + 77) & ((1u << form->bits) - 1u);
}

static int samples_of(const struct form *form)
{
    static const int counts[] = { 1, -1, 3, 1, 2, -1, 4 };
    return counts[form->colour_type];
}

static void pack_row(const struct form *form, int y, png_byte *row)
{
    const int samples = samples_of(form);
    memset(row, 0, W * 8);
    for (int i = 0; i < W * samples; i++) {
        const unsigned value = sample_of(form, i / samples, y, i % samples);
        if (form->bits == 16) {
            row[2 * i] = (png_byte)(value >> 8);
            row[2 * i + 1] = (png_byte)value;
        } else {
            const int bit = i * form->bits;
            row[bit / 8] |= (png_byte)(value << (8 - form->bits - bit % 8));
        }
    }
}

static png_byte palette_of(int entry, int c)
{
    return (png_byte)(entry * 37 + c * 91);
}

static void write_palette(const struct form *form, png_structp png, png_infop info)
{
    png_color palette[256];
    png_byte alpha[256];
    for (int i = 0; i < 256; i++) {
        palette[i] = (png_color){ palette_of(i, 0), palette_of(i, 1), palette_of(i, 2) };
        alpha[i] = palette_of(i, 3);
    }
    png_set_PLTE(png, info, palette, 1 << form->bits);
    // Fewer than there are colours: the others are opaque.
    if (form->transparent) png_set_tRNS(png, info, alpha, 1 << (form->bits - 1), NULL);
}

static void write_key(const struct form *form, png_structp png, png_infop info)
{
    const png_color_16 key = { .gray = (png_uint_16)sample_of(form, 4, 3, 0),
                               .red = (png_uint_16)sample_of(form, 4, 3, 0),
                               .green = (png_uint_16)sample_of(form, 4, 3, 1),
                               .blue = (png_uint_16)sample_of(form, 4, 3, 2) };
    png_set_tRNS(png, info, NULL, 0, &key);
}

static void write_png(const char *path, const struct form *form)
{
    FILE *stream = fopen(path, "wb");
    CHECK(stream);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, W, H, form->bits, form->colour_type, form->interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA(png, info, 1.0); // is ignored
    if (form->colour_type == PNG_COLOR_TYPE_PALETTE)
        write_palette(form, png, info);
    else if (form->transparent)
        write_key(form, png, info);
    png_write_info(png, info);
    png_byte rows[H][W * 8];
    png_bytep pointers[H];
    for (int y = 0; y < H; y++) {
        pack_row(form, y, rows[y]);
        pointers[y] = rows[y];
    }
    png_write_image(png, pointers);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(stream);
}

// The upper byte of 16 bits; fewer than 8 are spread.
static uint8_t code_of(const struct form *form, unsigned sample)
{
    if (form->bits == 16) return (uint8_t)(sample >> 8);
    return (uint8_t)(sample * 255u / ((1u << form->bits) - 1u));
}

static bool is_key(const struct form *form, int x, int y)
{
    bool same = form->transparent;
    for (int c = 0; c < samples_of(form); c++)
        same = same && sample_of(form, x, y, c) == sample_of(form, 4, 3, c);
    return same;
}

static void expect_pixel(const struct form *form, int x, int y, uint8_t rgba[4])
{
    const int samples = samples_of(form);
    rgba[3] = 255;
    if (form->colour_type == PNG_COLOR_TYPE_PALETTE) {
        const int entry = (int)sample_of(form, x, y, 0);
        for (int c = 0; c < 3; c++) rgba[c] = palette_of(entry, c);
        if (form->transparent && entry < 1 << (form->bits - 1)) rgba[3] = palette_of(entry, 3);
        return;
    }
    for (int c = 0; c < 3; c++) rgba[c] = code_of(form, sample_of(form, x, y, samples < 3 ? 0 : c));
    if (samples % 2 == 0) rgba[3] = code_of(form, sample_of(form, x, y, samples - 1));
    if (is_key(form, x, y)) rgba[3] = 0;
}

static void check_form(const struct form *form)
{
    const char *path = test_path("form.png");
    struct file_bytes file;
    int width, height;
    uint8_t *rgba;
    write_png(path, form);
    CHECK(file_read(test_host(), path, 0, &file));
    const char *why = decode(file, &width, &height, &rgba);
    if (why) fail_msg("%s", why);
    CHECK(width == W && height == H);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            uint8_t expected[4];
            expect_pixel(form, x, y, expected);
            if (memcmp(rgba + 4 * (y * W + x), expected, 4) != 0)
                fail_msg("colour type %d, %d bits, interlace %d, transparent %d: pixel %d, %d",
                         form->colour_type, form->bits, form->interlace, form->transparent, x, y);
        }
    free(rgba);
    file_bytes_finish(test_host(), &file);
}

TEST(png_of_every_form_has_the_exact_pixels)
{
    static const struct {
        int colour_type, least_bits, most_bits;
        bool key; // may have a chunk tRNS
    } forms[] = { { PNG_COLOR_TYPE_GRAY, 1, 16, true },
                  { PNG_COLOR_TYPE_RGB, 8, 16, true },
                  { PNG_COLOR_TYPE_PALETTE, 1, 8, true },
                  { PNG_COLOR_TYPE_GRAY_ALPHA, 8, 16, false },
                  { PNG_COLOR_TYPE_RGB_ALPHA, 8, 16, false } };
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        for (int bits = forms[i].least_bits; bits <= forms[i].most_bits; bits *= 2)
            for (int k = 0; k < (forms[i].key ? 4 : 2); k++)
                check_form(&(struct form){ forms[i].colour_type, bits,
                                           k % 2 ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                                           k / 2 > 0 });
}

static struct file_bytes png_file(const struct form *form)
{
    const char *path = test_path("whole.png");
    struct file_bytes file;
    write_png(path, form);
    CHECK(file_read(test_host(), path, 0, &file));
    return file;
}

// The chunk IEND, of 12 bytes, and the checksums before it are not needed.
TEST(a_png_that_ends_too_early_is_refused)
{
    struct file_bytes file = png_file(&(struct form){ PNG_COLOR_TYPE_RGB_ALPHA, 8, 0, false });
    const size_t whole = file.size;
    for (size_t size = 24; size < whole - 28; size++) {
        file.size = size;
        check_refused(file, "the file ends too early");
    }
    file.size = 23;
    check_refused(file, "it has no PNG header");
    file_bytes_finish(test_host(), &file);
}

// A file of 8192 x `rows` black pixels, whose header says one row.
static struct file_bytes png_with_rows_behind_its_last(int interlace, int rows)
{
    enum { HEIGHT_AT = 20 };
    static png_byte row[8192];
    const char *path = test_path("behind.png");
    struct file_bytes file;
    FILE *stream = fopen(path, "wb");
    CHECK(stream);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_set_IHDR(png, info, 8192, (png_uint_32)rows, 8, PNG_COLOR_TYPE_GRAY, interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, 0, PNG_FILTER_NONE);
    png_write_info(png, info);
    const int passes = png_set_interlace_handling(png);
    for (int i = 0; i < passes * rows; i++) png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(stream);
    CHECK(file_read(test_host(), path, 0, &file));
    memcpy(file.data + HEIGHT_AT, "\0\0\0\1", 4);
    return file;
}

// libpng unpacks them, and one byte unpacks to a thousand.
TEST(a_png_with_much_data_behind_its_last_row_is_refused)
{
    for (int interlace = 0; interlace < 2; interlace++) {
        struct file_bytes file = png_with_rows_behind_its_last(interlace, 2);
        int width, height;
        uint8_t *rgba;
        const char *why = decode(file, &width, &height, &rgba);
        if (why) fail_msg("interlace %d: %s", interlace, why);
        free(rgba);
        file_bytes_finish(test_host(), &file);
        file = png_with_rows_behind_its_last(interlace, 20000);
        check_refused(file, "it has data behind its last row");
        file_bytes_finish(test_host(), &file);
    }
}

TEST(a_png_of_a_size_beyond_the_limit_is_refused)
{
    struct file_bytes file = png_file(&(struct form){ PNG_COLOR_TYPE_GRAY, 8, 0, false });
    enum { WIDTH_AT = 16 };
    memcpy(file.data + WIDTH_AT, "\0\0\x20\x01", 4); // 8193
    check_refused(file, "it is larger than 8192 x 8192");
    memcpy(file.data + WIDTH_AT, "\x80\0\0\0", 4);
    check_refused(file, "it is larger than 8192 x 8192");
    memcpy(file.data + WIDTH_AT, "\0\0\0\0", 4);
    check_refused(file, "it has no pixels");
    file_bytes_finish(test_host(), &file);
}

// ---- JPEG

struct jpeg_form {
    J_COLOR_SPACE space; // of the samples: grey, RGB, or inks with Adobe's marker
    bool progressive, many_scans;
};

enum { JPEG_W = 21, JPEG_H = 13 };

// Slowly varying, so that a quality of 100 loses little.
static int jpeg_sample(int x, int y, int c)
{
    return 40 + 6 * x + 5 * y * (c == 1) + 30 * c;
}

// Each coefficient in two scans of its own.
static int split_scans(jpeg_scan_info *scans)
{
    int count = 0;
    scans[count++] = (jpeg_scan_info){ 1, { 0 }, 0, 0, 0, 0 };
    for (int k = 1; k < 64; k++) {
        scans[count++] = (jpeg_scan_info){ 1, { 0 }, k, k, 0, 1 };
        scans[count++] = (jpeg_scan_info){ 1, { 0 }, k, k, 1, 0 };
    }
    return count;
}

static void start_jpeg(struct jpeg_compress_struct *jpeg, const struct jpeg_form *form,
                       jpeg_scan_info *scans)
{
    jpeg->image_width = JPEG_W;
    jpeg->image_height = JPEG_H;
    jpeg->in_color_space = form->space;
    jpeg->input_components = form->space == JCS_GRAYSCALE ? 1 : form->space == JCS_RGB ? 3 : 4;
    jpeg_set_defaults(jpeg);
    jpeg_set_quality(jpeg, 100, TRUE);
    if (form->progressive) jpeg_simple_progression(jpeg);
    if (form->many_scans) {
        jpeg->num_scans = split_scans(scans);
        jpeg->scan_info = scans;
    }
    jpeg_start_compress(jpeg, TRUE);
}

static struct file_bytes jpeg_file(const struct jpeg_form *form)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    static jpeg_scan_info scans[128];
    unsigned char *data = NULL;
    unsigned long size = 0;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &data, &size);
    start_jpeg(&jpeg, form, scans);
    for (int y = 0; y < JPEG_H; y++) {
        JSAMPLE samples[JPEG_W * 4];
        JSAMPROW row = samples;
        for (int i = 0; i < JPEG_W * jpeg.input_components; i++)
            samples[i] =
                (JSAMPLE)jpeg_sample(i / jpeg.input_components, y, i % jpeg.input_components);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return (struct file_bytes){ .data = data, .size = size };
}

static double expected_code(const struct jpeg_form *form, int x, int y, int c)
{
    if (form->space == JCS_GRAYSCALE) return jpeg_sample(x, y, 0);
    if (form->space == JCS_RGB) return jpeg_sample(x, y, c);
    return jpeg_sample(x, y, c) * jpeg_sample(x, y, 3) / 255.0; // inks are stored inverted
}

TEST(jpeg_pixels_are_those_of_the_file_within_its_loss)
{
    static const struct jpeg_form forms[] = {
        { JCS_GRAYSCALE, false, false }, { JCS_GRAYSCALE, true, false }, { JCS_RGB, false, false },
        { JCS_RGB, true, false },        { JCS_CMYK, false, false },     { JCS_CMYK, true, false }
    };
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        struct file_bytes file = jpeg_file(&forms[i]);
        int width, height;
        uint8_t *rgba;
        double worst = 0.0;
        const char *why = decode(file, &width, &height, &rgba);
        if (why) fail_msg("%s", why);
        CHECK(width == JPEG_W && height == JPEG_H);
        for (int p = 0; p < JPEG_W * JPEG_H; p++) {
            for (int c = 0; c < 3; c++) {
                const double off =
                    rgba[4 * p + c] - expected_code(&forms[i], p % JPEG_W, p / JPEG_W, c);
                worst = off > worst ? off : -off > worst ? -off : worst;
            }
            CHECK(rgba[4 * p + 3] == 255);
        }
        print_message("colour space %d, progressive %d: off by at most %.2f\n", (int)forms[i].space,
                      forms[i].progressive, worst);
        CHECK(worst < (forms[i].space == JCS_RGB ? 6.0 : 1.0)); // chroma has half the resolution
        free(rgba);
        free(file.data);
    }
}

// The last two bytes are the end marker, which libjpeg does without.
TEST(a_jpeg_that_ends_too_early_is_refused)
{
    for (int progressive = 0; progressive < 2; progressive++) {
        struct file_bytes file = jpeg_file(&(struct jpeg_form){ JCS_RGB, progressive, false });
        const size_t whole = file.size;
        for (size_t size = 3; size < whole - 2; size++) {
            int width, height;
            uint8_t *rgba;
            file.size = size;
            if (!decode(file, &width, &height, &rgba))
                fail_msg("progressive %d: %zu of %zu bytes are enough", progressive, size, whole);
            free(rgba);
        }
        free(file.data);
    }
}

TEST(a_jpeg_of_more_than_100_scans_is_refused)
{
    struct file_bytes file = jpeg_file(&(struct jpeg_form){ JCS_GRAYSCALE, false, true });
    check_refused(file, "it has more than 100 scans");
    free(file.data);
}

// The segment of a marker; the size is in SOF0, its first word behind one byte.
static uint8_t *find_segment(struct file_bytes file, uint8_t marker)
{
    size_t at = 2;
    while (file.data[at + 1] != marker)
        at += 2 + ((size_t)file.data[at + 2] << 8 | file.data[at + 3]);
    return file.data + at + 4;
}

TEST(a_jpeg_of_a_size_beyond_the_limit_is_refused)
{
    struct file_bytes file = jpeg_file(&(struct jpeg_form){ JCS_RGB, false, false });
    memcpy(find_segment(file, 0xc0) + 1, "\x20\x01", 2); // 8193 rows
    check_refused(file, "it is larger than 8192 x 8192");
    free(file.data);
}

// Symbols of 16 lengths follow the table's class.
TEST(a_jpeg_huffman_table_of_more_than_256_symbols_is_refused)
{
    struct file_bytes file = jpeg_file(&(struct jpeg_form){ JCS_RGB, false, false });
    memset(find_segment(file, 0xc4) + 1, 17, 16);
    check_refused(file, "Bogus Huffman table definition");
    free(file.data);
}

// ---- others

TEST(bytes_of_no_known_format_are_refused)
{
    static uint8_t bytes[64] = "\xff\xd9 neither a marker that starts an image nor a signature";
    check_refused((struct file_bytes){ .data = bytes, .size = sizeof bytes }, "unknown image type");
    check_refused((struct file_bytes){ .data = bytes, .size = 0 }, "unknown image type");
}
