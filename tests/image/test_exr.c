#include "test_images.h"

#include "image/exr.h"

#include "core/files/file.h"
#include "core/half.h"

#include <openexr.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool same_image(const struct image *a, const struct image *b)
{
    return a->width == b->width && a->height == b->height && a->channels == b->channels &&
           memcmp(a->pixels, b->pixels,
                  (size_t)a->width * (size_t)a->height * (size_t)a->channels * sizeof(float)) == 0;
}

static bool write_one(const char *path, const char *layer, const struct image *image)
{
    return exr_write(test_host(), path, &(struct exr_layer){ layer, image }, 1, NULL, 0);
}

TEST(floats_survive_exactly_for_every_channel_count_and_height)
{
    static const int heights[] = { 1, 15, 16, 17, 33 };
    for (int channels = 1; channels <= 4; channels++) {
        for (size_t i = 0; i < sizeof heights / sizeof heights[0]; i++) {
            struct image image, back;
            noise_image(&image, 21, heights[i], channels);
            image.pixels[0] = 1e-42f; // denormal, then values that are not finite
            if (channels > 1) image.pixels[1] = -INFINITY;
            if (channels > 2) image.pixels[2] = NAN;
            const char *path = test_path("float.exr");
            CHECK(write_one(path, "color", &image));
            CHECK(exr_read(test_host(), path, NULL, &back));
            CHECK(same_image(&image, &back));
            image_finish(&image, test_host());
            image_finish(&back, test_host());
        }
    }
}

static const char LONG_NAME[] = "a.layer.whose.name.is.longer.than.thirty.one.characters";

// Layers of every kind of name, not in file order.
static void write_layers(const char *path, struct image images[5])
{
    static const int channels[5] = { 3, 1, 4, 2, 1 };
    static const char *const names[5] = { "normal", "depth", "color", LONG_NAME, "albedo" };
    struct exr_layer layers[5];
    for (int i = 0; i < 5; i++) {
        noise_image(&images[i], 19, 37, channels[i]);
        images[i].pixels[7] = (float)i;
        layers[i] = (struct exr_layer){ names[i], &images[i] };
    }
    static const struct exr_attribute attributes[] = {
        { "technique", "lpv:iterations=8" },
        { "comment", "" },
        { "an.attribute.whose.name.is.longer.than.31", "µ → ok" },
    };
    CHECK(exr_write(test_host(), path, layers, 5, attributes, 3));
}

// Every finite half, a value between two halves, and values beyond the largest.
TEST(files_in_memory_are_those_of_the_disk)
{
    struct image image, back;
    struct file_bytes file;
    uint8_t *bytes;
    size_t size;
    noise_image(&image, 37, 45, 3);
    CHECK(write_one(test_path("disk.exr"), "color", &image));
    CHECK(file_read(test_host(), test_path("disk.exr"), 0, &file));
    CHECK(exr_encode(test_host(), &image, &bytes, &size));
    CHECK(size == file.size && memcmp(bytes, file.data, size) == 0);
    CHECK(exr_decode(test_host(), "memory", bytes, size, 37 * 45, &back));
    CHECK(same_image(&image, &back));
    image_finish(&back, test_host());
    CHECK(!exr_decode(test_host(), "memory", bytes, size, 37 * 45 - 1, &back) && !back.pixels);
    CHECK(!exr_decode(test_host(), "memory", bytes, size / 2, 37 * 45, &back) && !back.pixels);
    CHECK(!exr_decode(test_host(), "memory", bytes, 0, 37 * 45, &back) && !back.pixels);
    host_free(test_host(), bytes);
    file_bytes_finish(test_host(), &file);
    image_finish(&image, test_host());
}

TEST(half_floats_survive_exactly_and_others_are_rounded)
{
    struct image image, back;
    CHECK(image_init(&image, test_host(), 256, 256, 1));
    for (uint32_t i = 0; i < 65536; i++)
        image.pixels[i] = (i & 0x7c00) == 0x7c00 ? 1e6f : float_from_half((uint16_t)i);
    image.pixels[1] = 1.0f + 0.0003f;
    const char *path = test_path("half.exr");
    CHECK(exr_write_half(test_host(), path, &(struct exr_layer){ "color", &image }, 1, NULL, 0));
    CHECK(exr_read(test_host(), path, NULL, &back));
    for (uint32_t i = 2; i < 65536; i++)
        CHECK((i & 0x7c00) == 0x7c00 ? isinf(back.pixels[i]) : back.pixels[i] == image.pixels[i]);
    CHECK(back.pixels[1] == 1.0f);
    image_finish(&image, test_host());
    image_finish(&back, test_host());
}

TEST(every_layer_comes_back_by_its_name)
{
    static const char *const names[5] = { "normal", "depth", "color", LONG_NAME, "albedo" };
    struct image images[5], back;
    const char *path = test_path("layers.exr");
    write_layers(path, images);
    for (int i = 0; i < 5; i++) {
        CHECK(exr_read(test_host(), path, names[i], &back));
        CHECK(same_image(&images[i], &back));
        image_finish(&back, test_host());
        image_finish(&images[i], test_host());
    }
}

TEST(layer_names_are_listed_once_in_the_order_of_the_file)
{
    struct image images[5];
    const char *path = test_path("layers.exr");
    write_layers(path, images);
    char *names = exr_layer_names(test_host(), path);
    CHECK(names);
    char expected[200];
    snprintf(expected, sizeof expected, "color\ndepth\n%s\nalbedo\nnormal", LONG_NAME);
    CHECK_STRING(names, expected);
    host_free(test_host(), names);
    for (int i = 0; i < 5; i++) image_finish(&images[i], test_host());
}

TEST(channels_are_stored_under_the_names_that_other_programs_expect)
{
    struct image images[5];
    const char *path = test_path("layers.exr");
    write_layers(path, images);
    exr_context_t context = NULL;
    const exr_attr_chlist_t *list;
    exr_compression_t compression;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    CHECK(exr_start_read(&context, path, &init) == EXR_ERR_SUCCESS);
    CHECK(exr_get_channels(context, 0, &list) == EXR_ERR_SUCCESS);
    static const char *const head[] = { "A", "B", "G", "R", "Z" };
    CHECK(list->num_channels == 11);
    for (int i = 0; i < 5; i++) CHECK_STRING(list->entries[i].name.str, head[i]);
    CHECK_STRING(list->entries[7].name.str, "albedo.Y");
    CHECK_STRING(list->entries[8].name.str, "normal.B");
    for (int i = 0; i < list->num_channels; i++) {
        CHECK(list->entries[i].pixel_type == EXR_PIXEL_FLOAT);
        CHECK(i == 0 || strcmp(list->entries[i - 1].name.str, list->entries[i].name.str) < 0);
    }
    CHECK(exr_get_compression(context, 0, &compression) == EXR_ERR_SUCCESS);
    CHECK(compression == EXR_COMPRESSION_ZIP);
    exr_finish(&context);
    for (int i = 0; i < 5; i++) image_finish(&images[i], test_host());
}

TEST(text_attributes_come_back_and_absent_ones_are_no_failure)
{
    struct image images[5];
    const char *path = test_path("layers.exr");
    write_layers(path, images);
    char *value = exr_attribute_value(test_host(), path, "technique");
    CHECK(value);
    CHECK_STRING(value, "lpv:iterations=8");
    host_free(test_host(), value);
    value = exr_attribute_value(test_host(), path, "comment");
    CHECK(value);
    CHECK_STRING(value, "");
    host_free(test_host(), value);
    value = exr_attribute_value(test_host(), path, "an.attribute.whose.name.is.longer.than.31");
    CHECK(value);
    CHECK_STRING(value, "µ → ok");
    host_free(test_host(), value);
    test_forget_messages();
    CHECK(!exr_attribute_value(test_host(), path, "nothing"));
    CHECK(!exr_attribute_value(test_host(), path, "dataWindow")); // not a text attribute
    CHECK_STRING(test_last_message(), "");
    CHECK(!exr_attribute_value(test_host(), "/nowhere/at.exr", "technique"));
    CHECK(strstr(test_last_message(), "/nowhere/at.exr"));
    for (int i = 0; i < 5; i++) image_finish(&images[i], test_host());
}

static void check_attribute(const char *path, const char *expected)
{
    char *value = exr_attribute_value(test_host(), path, "scene");
    CHECK(value);
    CHECK_STRING(value, expected);
    host_free(test_host(), value);
}

static void write_attribute(const char *path, const char *value)
{
    struct image image;
    noise_image(&image, 64, 64, 3);
    CHECK(exr_write(test_host(), path, &(struct exr_layer){ "color", &image }, 1,
                    &(struct exr_attribute){ "scene", value }, 1));
    image_finish(&image, test_host());
}

// A file of 5 GiB would not be read whole.
TEST(an_attribute_is_read_from_the_header_alone)
{
    struct image image;
    int width, height;
    const char *path = test_path("header.exr");
    write_attribute(path, "@maze");
    CHECK(truncate(path, (off_t)5 << 30) == 0);
    check_attribute(path, "@maze");
    CHECK(exr_read_size(test_host(), path, &width, &height) && width == 64 && height == 64);
    CHECK(!exr_read(test_host(), path, NULL, &image));
    CHECK(strstr(test_last_message(), "more than the 4294967296 allowed"));
    CHECK(truncate(path, 2000) == 0); // without most pixels
    check_attribute(path, "@maze");
    CHECK(truncate(path, 100) == 0);
    CHECK(!exr_attribute_value(test_host(), path, "scene"));
    CHECK(strstr(test_last_message(), path));
}

TEST(a_header_of_any_length_is_read)
{
    static char longest[(3 << 20) + 1];
    const char *path = test_path("long-header.exr");
    memset(longest, 'x', sizeof longest - 1);
    write_attribute(path, longest);
    test_forget_messages();
    check_attribute(path, longest);
    CHECK_STRING(test_last_message(), "");
    CHECK(truncate(path, 2 << 20) == 0);
    CHECK(!exr_attribute_value(test_host(), path, "scene"));
    CHECK(strstr(test_last_message(), path));
}

TEST(the_same_layers_give_the_same_bytes)
{
    struct image images[5];
    struct file_bytes first, second;
    const char *a = test_path("first.exr"), *b = test_path("second.exr");
    write_layers(a, images);
    for (int i = 0; i < 5; i++) image_finish(&images[i], test_host());
    write_layers(b, images);
    for (int i = 0; i < 5; i++) image_finish(&images[i], test_host());
    CHECK(file_read(test_host(), a, 0, &first));
    CHECK(file_read(test_host(), b, 0, &second));
    CHECK(first.size == second.size && memcmp(first.data, second.data, first.size) == 0);
    file_bytes_finish(test_host(), &first);
    file_bytes_finish(test_host(), &second);
}

TEST(the_error_for_a_missing_layer_lists_those_present)
{
    struct image images[5], back;
    const char *path = test_path("layers.exr");
    write_layers(path, images);
    CHECK(!exr_read(test_host(), path, "irradiance", &back));
    CHECK(!back.pixels);
    CHECK(strstr(test_last_message(), "'irradiance'"));
    CHECK(strstr(test_last_message(), "color depth"));
    CHECK(strstr(test_last_message(), "albedo normal"));
    CHECK(test_host()->failure == FAIL_ARGUMENT);
    for (int i = 0; i < 5; i++) image_finish(&images[i], test_host());
}

TEST(invalid_layers_are_refused)
{
    struct image a, b;
    noise_image(&a, 4, 4, 3);
    noise_image(&b, 5, 4, 3);
    const char *path = test_path("refused.exr");
    struct exr_layer two[2] = { { "color", &a }, { "normal", &b } };
    CHECK(!exr_write(test_host(), path, two, 2, NULL, 0));
    CHECK(strstr(test_last_message(), "5x4") && strstr(test_last_message(), "4x4"));
    two[1] = (struct exr_layer){ "color", &a };
    CHECK(!exr_write(test_host(), path, two, 2, NULL, 0));
    CHECK(strstr(test_last_message(), "twice"));
    CHECK(!write_one(path, "", &a));
    CHECK(!write_one(path, "a\nb", &a));
    CHECK(!exr_write(test_host(), path, two, 0, NULL, 0));
    static const char *const names[] = { "channels", "type", "", "comment" };
    for (int i = 0; i < 4; i++) {
        struct exr_attribute attribute = { names[i], i < 3 ? "x" : NULL };
        CHECK(!exr_write(test_host(), path, two, 1, &attribute, 1));
        CHECK(strstr(test_last_message(), "attribute"));
    }
    struct file_bytes none;
    CHECK(!file_read(test_host(), path, 0, &none)); // no partial file
    image_finish(&a, test_host());
    image_finish(&b, test_host());
}

TEST(a_file_that_cannot_be_created_is_a_failure_that_names_it)
{
    struct image a;
    noise_image(&a, 4, 4, 3);
    CHECK(!write_one("/nowhere/out.exr", "color", &a));
    CHECK(strstr(test_last_message(), "/nowhere/out.exr"));
    CHECK(test_host()->failure == FAIL_FILE);
    image_finish(&a, test_host());
}

// ---- files of other programs

struct foreign {
    exr_pixel_type_t type;
    exr_compression_t compression;
    exr_lineorder_t order;
    const char *names[4];
    int channels;
    exr_attr_box2i_t window;
    int sampling;
    bool raw_halves; // pixel i is the half with the bits i
};

// Value of channel c at (x, y), exact in all three types.
static unsigned foreign_value(int c, int x, int y)
{
    return (unsigned)(64 * c + 8 * y + x);
}

// The bits of a half with the value of a small integer.
static uint16_t half_of(unsigned value)
{
    if (value == 0) return 0;
    int exponent = 0;
    while (value >> (exponent + 1)) exponent++;
    return (uint16_t)((unsigned)(exponent + 15) << 10 | ((value << (10 - exponent)) & 0x3ff));
}

static void put_value(void *at, exr_pixel_type_t type, unsigned value)
{
    float as_float = (float)value;
    uint32_t as_uint = value;
    uint16_t as_half = half_of(value);
    if (type == EXR_PIXEL_FLOAT) memcpy(at, &as_float, sizeof as_float);
    if (type == EXR_PIXEL_UINT) memcpy(at, &as_uint, sizeof as_uint);
    if (type == EXR_PIXEL_HALF) memcpy(at, &as_half, sizeof as_half);
}

#define MUST(call) CHECK((call) == EXR_ERR_SUCCESS)

static void encode_foreign_chunk(exr_context_t context, const struct foreign *f, int y,
                                 const uint8_t *planes, size_t plane_bytes, int size)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    int width = f->window.max.x - f->window.min.x + 1;
    MUST(exr_write_scanline_chunk_info(context, 0, y, &chunk));
    MUST(exr_encoding_initialize(context, 0, &chunk, &encode));
    for (int i = 0; i < encode.channel_count; i++) {
        int c = 0;
        while (strcmp(f->names[c], encode.channels[i].channel_name) != 0) c++;
        encode.channels[i].user_data_type = (uint16_t)f->type;
        encode.channels[i].user_bytes_per_element = (int16_t)size;
        encode.channels[i].user_pixel_stride = size;
        encode.channels[i].user_line_stride = width * size;
        encode.channels[i].encode_from_ptr =
            planes + (size_t)c * plane_bytes +
            (size_t)(y - f->window.min.y) * (size_t)width * (size_t)size;
    }
    MUST(exr_encoding_choose_default_routines(context, 0, &encode));
    MUST(exr_encoding_run(context, 0, &encode));
    MUST(exr_encoding_destroy(context, &encode));
}

static void write_foreign(const char *path, const struct foreign *f)
{
    exr_context_t context = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part, lines, size = f->type == EXR_PIXEL_HALF ? 2 : 4;
    int width = f->window.max.x - f->window.min.x + 1,
        height = f->window.max.y - f->window.min.y + 1;
    exr_attr_v2f_t centre = { .x = 0, .y = 0 };
    MUST(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &init));
    MUST(exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part));
    MUST(exr_initialize_required_attr(context, 0, &f->window, &f->window, 1.0f, &centre, 1.0f,
                                      f->order, f->compression));
    for (int c = 0; c < f->channels; c++)
        MUST(exr_add_channel(context, 0, f->names[c], f->type, EXR_PERCEPTUALLY_LOGARITHMIC,
                             f->sampling, f->sampling));
    MUST(exr_write_header(context));
    size_t plane_bytes = (size_t)width * (size_t)height * (size_t)size;
    uint8_t *planes = calloc((size_t)f->channels, plane_bytes);
    CHECK(planes);
    for (int i = 0; f->raw_halves && i < width * height; i++)
        memcpy(planes + 2 * i, &(uint16_t){ (uint16_t)i }, 2);
    for (int c = 0; !f->raw_halves && c < f->channels; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                put_value(planes + (size_t)c * plane_bytes + (size_t)((y * width + x) * size),
                          f->type, foreign_value(c, x, y));
    MUST(exr_get_scanlines_per_chunk(context, 0, &lines));
    int chunks = (height + lines - 1) / lines;
    for (int i = 0; i < chunks; i++) {
        encode_foreign_chunk(context, f, f->window.min.y + i * lines, planes, plane_bytes, size);
    }
    free(planes);
    MUST(exr_finish(&context));
}

static struct foreign foreign_rgb(exr_pixel_type_t type, exr_compression_t compression)
{
    return (struct foreign){ .type = type,
                             .compression = compression,
                             .order = EXR_LINEORDER_INCREASING_Y,
                             .names = { "R", "G", "B" },
                             .channels = 3,
                             .window = { .min = { .x = 0, .y = 0 }, .max = { .x = 6, .y = 7 } },
                             .sampling = 1 };
}

static void check_foreign(const char *path, const char *layer, int channels)
{
    struct image back;
    CHECK(exr_read(test_host(), path, layer, &back));
    CHECK(back.width == 7 && back.height == 8 && back.channels == channels);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 7; x++)
            for (int c = 0; c < channels; c++)
                CHECK(image_at(&back, x, y)[c] == (float)foreign_value(c, x, y));
    image_finish(&back, test_host());
}

TEST(halves_floats_and_integers_of_every_lossless_compression_are_read)
{
    static const exr_pixel_type_t types[] = { EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT };
    static const exr_compression_t compressions[] = { EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                                      EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                                      EXR_COMPRESSION_PIZ };
    for (size_t t = 0; t < 3; t++) {
        for (size_t i = 0; i < sizeof compressions / sizeof compressions[0]; i++) {
            struct foreign f = foreign_rgb(types[t], compressions[i]);
            const char *path = test_path("foreign.exr");
            write_foreign(path, &f);
            check_foreign(path, NULL, 3);
        }
    }
}

// The line order gives the order of the chunks in the file; the offset table locates each chunk.
TEST(a_window_away_from_the_origin_and_any_line_order_are_read)
{
    struct foreign f = foreign_rgb(EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIPS);
    f.window = (exr_attr_box2i_t){ .min = { .x = -3, .y = -100 }, .max = { .x = 3, .y = -93 } };
    f.order = EXR_LINEORDER_DECREASING_Y;
    const char *path = test_path("window.exr");
    write_foreign(path, &f);
    check_foreign(path, "color", 3);
}

TEST(vectors_and_depths_of_other_programs_are_layers_too)
{
    struct foreign f = foreign_rgb(EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIP);
    memcpy(f.names, (const char *[]){ "View.Normal.X", "View.Normal.Y", "View.Normal.Z" },
           3 * sizeof(char *));
    const char *path = test_path("vectors.exr");
    write_foreign(path, &f);
    check_foreign(path, "View.Normal", 3);
    memcpy(f.names, (const char *[]){ "View.Depth.Z", "View.Mist.V", "odd" }, 3 * sizeof(char *));
    write_foreign(path, &f);
    check_foreign(path, "View.Depth", 1);
    char *names = exr_layer_names(test_host(), path);
    CHECK(names);
    CHECK_STRING(names, "View.Depth\nView.Mist");
    host_free(test_host(), names);
    struct image back;
    CHECK(!exr_read(test_host(), path, "color", &back));
    CHECK(strstr(test_last_message(), "View.Depth View.Mist"));
}

// Reading one channel of four, and three of four.
TEST(one_layer_is_read_from_among_others)
{
    static const exr_pixel_type_t types[] = { EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, EXR_PIXEL_UINT };
    for (size_t t = 0; t < 3; t++) {
        for (int compression = EXR_COMPRESSION_NONE; compression <= EXR_COMPRESSION_PIZ;
             compression++) {
            struct foreign f = foreign_rgb(types[t], (exr_compression_t)compression);
            f.names[3] = "Z";
            f.channels = 4;
            const char *path = test_path("among.exr");
            write_foreign(path, &f);
            check_foreign(path, "color", 3);
            struct image depth;
            CHECK(exr_read(test_host(), path, "depth", &depth));
            CHECK(depth.channels == 1);
            for (int y = 0; y < 8; y++)
                for (int x = 0; x < 7; x++)
                    CHECK(*image_at(&depth, x, y) == (float)foreign_value(3, x, y));
            image_finish(&depth, test_host());
        }
    }
}

// All 65536 halves, since exr_read.c has its own decoder.
TEST(all_halves_are_read_exactly)
{
    struct foreign f = foreign_rgb(EXR_PIXEL_HALF, EXR_COMPRESSION_NONE);
    f.names[0] = "Y";
    f.channels = 1;
    f.window.max = (exr_attr_v2i_t){ .x = 255, .y = 255 };
    f.raw_halves = true;
    const char *path = test_path("halves.exr");
    write_foreign(path, &f);
    struct image back;
    CHECK(exr_read(test_host(), path, "color", &back));
    for (int i = 0; i < 65536; i++) {
        int exponent = i >> 10 & 31, mantissa = i & 1023;
        double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
        double expected = i & 0x8000 ? -size : size;
        double value = (double)back.pixels[i];
        if (exponent < 31)
            CHECK(value == expected && signbit(value) == signbit(expected));
        else if (mantissa)
            CHECK(isnan(value));
        else
            CHECK(isinf(value) && (value < 0) == (i >= 0x8000));
    }
    image_finish(&back, test_host());
}

TEST(subsampled_channels_are_refused)
{
    struct foreign f = foreign_rgb(EXR_PIXEL_HALF, EXR_COMPRESSION_NONE);
    f.window.max = (exr_attr_v2i_t){ .x = 7, .y = 7 };
    f.sampling = 2;
    const char *path = test_path("subsampled.exr");
    write_foreign(path, &f);
    struct image back;
    CHECK(!exr_read(test_host(), path, NULL, &back));
    CHECK(strstr(test_last_message(), "fewer samples than pixels"));
    CHECK(test_host()->failure == FAIL_UNSUPPORTED);
}

TEST(tiled_files_are_refused_and_called_tiled)
{
    const char *path = test_path("tiled.exr");
    exr_context_t context = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part;
    MUST(exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &init));
    MUST(exr_add_part(context, NULL, EXR_STORAGE_TILED, &part));
    MUST(exr_initialize_required_attr_simple(context, 0, 8, 8, EXR_COMPRESSION_NONE));
    MUST(exr_set_tile_descriptor(context, 0, 8, 8, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN));
    MUST(exr_add_channel(context, 0, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    MUST(exr_write_header(context));
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    float pixels[64] = { 0 };
    MUST(exr_write_tile_chunk_info(context, 0, 0, 0, 0, 0, &chunk));
    MUST(exr_encoding_initialize(context, 0, &chunk, &encode));
    encode.channels[0].user_pixel_stride = 4;
    encode.channels[0].user_line_stride = 32;
    encode.channels[0].encode_from_ptr = (const uint8_t *)pixels;
    MUST(exr_encoding_choose_default_routines(context, 0, &encode));
    MUST(exr_encoding_run(context, 0, &encode));
    MUST(exr_encoding_destroy(context, &encode));
    MUST(exr_finish(&context));
    struct image back;
    CHECK(!exr_read(test_host(), path, NULL, &back));
    CHECK(strstr(test_last_message(), "tiled"));
    CHECK(test_host()->failure == FAIL_UNSUPPORTED);
    CHECK(!exr_layer_names(test_host(), path));
}
