// Image decoding of untrusted data.
#include "framework/test.h"

#include "scene/image_decode.h"

#include <string.h>

static const uint8_t SOI[] = { 0xff, 0xd8 };
// Baseline, 8 bits, 3 x 2 pixels, one component.
static const uint8_t SOF[] = { 0xff, 0xc0, 0, 11, 8, 0, 2, 0, 3, 1, 1, 0x11, 0 };
enum { DHT_HEAD = 5 };

struct bytes {
    uint8_t data[2048];
    size_t size;
};

static void add(struct bytes *file, const uint8_t *data, size_t size)
{
    memcpy(file->data + file->size, data, size);
    file->size += size;
}

// A table with `each` codes of each of the 16 lengths, in a segment of the stated `length`.
static void add_table(struct bytes *file, uint8_t each, size_t length)
{
    const uint8_t head[DHT_HEAD] = { 0xff, 0xc4, (uint8_t)(length >> 8), (uint8_t)length, 0 };
    add(file, head, sizeof head);
    for (int i = 0; i < 16; i++) add(file, &each, 1);
    for (int i = 0; i < 16 * each; i++) add(file, (const uint8_t[]){ 0 }, 1);
}

static const char *size_of(const struct bytes *file, int *width, int *height)
{
    return image_decode_size(file->data, file->size, width, height);
}

TEST(jpeg_size_is_read_from_the_header)
{
    struct bytes file = { 0 };
    int width = 0, height = 0;
    add(&file, SOI, sizeof SOI);
    add_table(&file, 0, 2 + 17);
    add(&file, SOF, sizeof SOF);
    const char *why = size_of(&file, &width, &height);
    if (why) fail_msg("%s", why);
    assert_int_equal(width, 3);
    assert_int_equal(height, 2);
}

// 272 symbols, in a segment that includes them and in one that ends after the table's class.
TEST(a_jpeg_huffman_table_of_more_than_256_symbols_is_refused)
{
    static const size_t lengths[] = { 2 + 17 + 272, 3 };
    for (int i = 0; i < 2; i++) {
        struct bytes file = { 0 };
        int width, height;
        add(&file, SOI, sizeof SOI);
        add_table(&file, 17, lengths[i]);
        add(&file, SOF, sizeof SOF);
        CHECK_STRING(size_of(&file, &width, &height), "a Huffman table has more than 256 symbols");
    }
}

// The contents of comments and embedded thumbnails are not tables.
TEST(jpeg_segments_without_tables_are_skipped)
{
    struct bytes file = { 0 };
    int width = 0, height = 0;
    add(&file, SOI, sizeof SOI);
    add(&file, (const uint8_t[]){ 0xff, 0xfe, 2, 2 }, 4);
    const size_t begin = file.size;
    add_table(&file, 17, 2 + 17 + 272);
    file.size = begin + 512;
    add(&file, SOF, sizeof SOF);
    const char *why = size_of(&file, &width, &height);
    if (why) fail_msg("%s", why);
    assert_int_equal(width, 3);
}

// Width, height, 8 bits, RGB; CRCs are not read.
static void add_png_head(struct bytes *file)
{
    add(file, (const uint8_t *)"\x89PNG\r\n\x1a\n", 8);
    add(file, (const uint8_t *)"\0\0\0\x0dIHDR\0\0\0\x03\0\0\0\x02\x08\x02\0\0\0", 21);
    add(file, (const uint8_t[4]){ 0 }, 4);
}

// A chunk before it is skipped by its length.
TEST(a_png_with_an_empty_first_idat_chunk_is_refused)
{
    for (uint8_t length = 0; length < 2; length++) {
        struct bytes file = { 0 };
        int width = 0, height = 0;
        add_png_head(&file);
        add(&file, (const uint8_t *)"\0\0\0\4tEXtIDAT\0\0\0\0", 16);
        add(&file, (const uint8_t[]){ 0, 0, 0, length }, 4);
        add(&file, (const uint8_t *)"IDAT", 4);
        const char *why = size_of(&file, &width, &height);
        CHECK_STRING(why ? why : "none", length == 0 ? "its first IDAT chunk is empty" : "none");
    }
}
