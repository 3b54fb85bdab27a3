// KTX2 files and their texels. Programs of others read them in tests/web.
#include "framework/test.h"

#include "core/files/file.h"
#include "image/ktx2.h"
#include "image/rgb9e5.h"

#include <math.h>
#include <string.h>

// ---- RGB9E5

static float step_of(uint32_t packed)
{
    return ldexpf(1.0f, (int)(packed >> 27) - 24);
}

static void check_nearest(const float rgb[3])
{
    float back[3];
    const uint32_t packed = rgb9e5_pack(rgb);
    rgb9e5_unpack(packed, back);
    for (int c = 0; c < 3; c++) CHECK(fabsf(back[c] - rgb[c]) <= 0.5f * step_of(packed));
    const bool is_half = (packed | packed >> 9 | packed >> 18) & 256u;
    CHECK(packed >> 27 == 0 || is_half); // the exponent is the least one
}

TEST(packed_values_are_within_half_a_step_of_the_least_exponent)
{
    for (int exponent = -30; exponent < 16; exponent++)
        for (int i = 0; i < 200; i++) {
            const float x = ldexpf(1.0f + (float)i / 200.0f, exponent);
            check_nearest((const float[3]){ x, 0.3f * x, 0.01f * x });
            check_nearest((const float[3]){ 0, 0.7f * x, x });
        }
}

TEST(packed_values_outside_the_range_are_its_ends)
{
    static const float given[][3] = { { 1e9f, INFINITY, 65408 }, { -1, NAN, 0 } };
    static const float ends[] = { RGB9E5_MAX, 0 };
    for (int i = 0; i < 2; i++) {
        float back[3];
        rgb9e5_unpack(rgb9e5_pack(given[i]), back);
        for (int c = 0; c < 3; c++) CHECK(back[c] == ends[i]);
    }
    CHECK(rgb9e5_pack((const float[3]){ 1, 1, 1 }) == 0x84020100u);
}

// ---- files

static struct image gradient(float most)
{
    struct image image = { 0 };
    CHECK(image_init(&image, test_host(), 7, 5, 3));
    for (int i = 0; i < 7 * 5 * 3; i++) image.pixels[i] = most * (float)(i + 1) / (7 * 5 * 3);
    return image;
}

static uint32_t u32_at(const struct file_bytes *file, size_t at)
{
    uint32_t value;
    CHECK(at + 4 <= file->size);
    memcpy(&value, file->data + at, sizeof value);
    return value;
}

// Entries as "key=value;", in the order of the file.
static void list_entries(const struct file_bytes *file, char *out, size_t size)
{
    size_t at = u32_at(file, 56), used = 0;
    const size_t end = at + u32_at(file, 60);
    while (at < end) {
        const char *key = (const char *)file->data + at + 4, *value = key + strlen(key) + 1;
        const size_t bytes = u32_at(file, at);
        CHECK(at % 4 == 0 && strlen(key) + strlen(value) + 2 == bytes);
        used += (size_t)snprintf(out + used, size - used, "%s=%s;", key, value);
        at += 4 + (bytes + 3) / 4 * 4;
    }
    CHECK(at == end);
}

TEST(file_has_the_texels_and_sorted_entries)
{
    struct image image = gradient(100000);
    struct file_bytes file;
    char entries[200];
    const struct ktx2_entry given[] = { { "b", "2" }, { "a.long", "12345" } };
    const float scale = ktx2_scale(&image);
    CHECK(ktx2_write(test_host(), test_path("gradient.ktx2"), &image, scale, given, 2));
    CHECK(file_read(test_host(), test_path("gradient.ktx2"), 0, &file));
    list_entries(&file, entries, sizeof entries);
    CHECK_STRING(entries, "KTXorientation=rd;KTXwriter=afterglow;a.long=12345;b=2;");
    const size_t texels = u32_at(&file, 80);
    CHECK(texels == u32_at(&file, 56) + u32_at(&file, 60) && texels % 4 == 0);
    CHECK(texels + 4 * 7 * 5 == file.size && u32_at(&file, 88) == 4 * 7 * 5);
    CHECK(u32_at(&file, u32_at(&file, 48)) == u32_at(&file, 52));
    for (size_t i = 0; i < 7 * 5; i++) {
        float rgb[3];
        rgb9e5_unpack(u32_at(&file, texels + 4 * i), rgb);
        for (size_t c = 0; c < 3; c++)
            CHECK_NEAR(scale * rgb[c], image.pixels[3 * i + c], 100000.0f / 512.0f);
    }
    file_bytes_finish(test_host(), &file);
    image_finish(&image, test_host());
}

TEST(scale_is_that_of_the_unit_where_the_values_fit)
{
    static const float most[] = { 1, 65408, 65409, 500000, 0.3f, 1e-20f, 0 };
    static const float scales[] = { 1, 1, 2, 8, 0.5f, 0, 1 };
    for (size_t i = 0; i < sizeof most / sizeof *most; i++) {
        struct image image = gradient(most[i]);
        const float scale = ktx2_scale(&image);
        CHECK(most[i] / scale <= RGB9E5_MAX);
        if (scales[i] > 0)
            CHECK(scale == scales[i]);
        else
            CHECK(scale < 2 * most[i]);
        image_finish(&image, test_host());
    }
}

TEST(file_that_cannot_be_written_is_refused_in_one_sentence)
{
    struct image image = gradient(1), gray = { 0 };
    CHECK(!ktx2_write(test_host(), test_path("absent/x.ktx2"), &image, 1, NULL, 0));
    CHECK(strstr(test_last_message(), "absent/x.ktx2"));
    CHECK(image_init(&gray, test_host(), 2, 2, 1));
    CHECK(!ktx2_write(test_host(), test_path("gray.ktx2"), &gray, 1, NULL, 0));
    image_finish(&gray, test_host());
    image_finish(&image, test_host());
}
