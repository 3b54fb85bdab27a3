// Image files are untrusted: truncated or corrupted, they are refused with a message or read as a
// complete image, without leaks (under the address sanitizer) or hangs.
#include "test_images.h"

#include "image/exr.h"
#include "image/png_file.h"

#include "core/files/file.h"

#include <string.h>

static void save(const char *path, const uint8_t *data, size_t size)
{
    FILE *stream = fopen(path, "wb");
    CHECK(stream);
    CHECK(fwrite(data, 1, size, stream) == size);
    CHECK(fclose(stream) == 0);
}

static bool read_exr(const char *path, struct image *out)
{
    return exr_read(test_host(), path, "normal", out);
}

static bool read_png(const char *path, struct image *out)
{
    return png_read(test_host(), path, out);
}

static void make_exr(const char *path)
{
    struct image color, normal;
    noise_image(&color, 13, 35, 3);
    flat_image(&normal, 13, 35, 3, 0.5f); // compressible, unlike the noise
    const struct exr_layer layers[] = { { "color", &color }, { "normal", &normal } };
    const struct exr_attribute attribute = { "scene", "@cornell" };
    CHECK(exr_write(test_host(), path, layers, 2, &attribute, 1));
    image_finish(&color, test_host());
    image_finish(&normal, test_host());
}

static void make_png(const char *path)
{
    struct image image;
    noise_image(&image, 23, 11, 4);
    CHECK(png_write(test_host(), path, &image));
    image_finish(&image, test_host());
}

typedef bool (*reader)(const char *path, struct image *out);

static void check_cut_everywhere(const char *path, reader read)
{
    struct file_bytes whole;
    struct image image;
    CHECK(read(path, &image));
    image_finish(&image, test_host());
    CHECK(file_read(test_host(), path, 0, &whole));
    const char *cut = test_path("cut");
    for (size_t size = 0; size < whole.size; size++) {
        save(cut, whole.data, size);
        test_forget_messages();
        test_host()->failure = FAIL_NONE;
        if (read(cut, &image)) fail_msg("cut to %zu of %zu bytes it was read", size, whole.size);
        CHECK(!image.pixels);
        CHECK(strstr(test_last_message(), "cannot read ") && strstr(test_last_message(), cut));
        CHECK(test_host()->failure == FAIL_FORMAT);
    }
    file_bytes_finish(test_host(), &whole);
}

// Both outcomes are valid, but a failure logs a message and allocates nothing.
static void check_changed(const char *path, const uint8_t *data, size_t size, reader read)
{
    struct image image;
    save(path, data, size);
    test_forget_messages();
    if (read(path, &image)) {
        CHECK(image.pixels && image.width >= 1 && image.height >= 1);
        image_finish(&image, test_host());
    } else {
        CHECK(!image.pixels && test_last_message()[0]);
    }
    char *names = exr_layer_names(test_host(), path);
    host_free(test_host(), names);
    char *value = exr_attribute_value(test_host(), path, "scene");
    host_free(test_host(), value);
}

// Flips bits of each byte of the header and table, and of every 17th byte behind them.
static void check_changed_everywhere(const char *path, size_t dense, reader read)
{
    static const uint8_t masks[] = { 0xff, 0x01, 0x80 };
    struct file_bytes whole;
    CHECK(file_read(test_host(), path, 0, &whole));
    const char *changed = test_path("changed");
    for (size_t at = 0; at < whole.size; at += at < dense ? 1 : 17) {
        for (size_t m = 0; m < sizeof masks; m++) {
            whole.data[at] ^= masks[m];
            check_changed(changed, whole.data, whole.size, read);
            whole.data[at] ^= masks[m];
        }
    }
    file_bytes_finish(test_host(), &whole);
}

TEST(an_exr_cut_at_any_length_is_refused_with_a_message)
{
    const char *path = test_path("whole.exr");
    make_exr(path);
    check_cut_everywhere(path, read_exr);
}

TEST(a_png_cut_at_any_length_is_refused_with_a_message)
{
    const char *path = test_path("whole.png");
    make_png(path);
    check_cut_everywhere(path, read_png);
}

TEST(an_exr_with_any_byte_changed_is_read_or_refused)
{
    const char *path = test_path("whole.exr");
    make_exr(path);
    check_changed_everywhere(path, 700, read_exr);
}

TEST(a_png_with_any_byte_changed_is_read_or_refused)
{
    const char *path = test_path("whole.png");
    make_png(path);
    check_changed_everywhere(path, 200, read_png);
}

TEST(a_folder_and_a_missing_file_are_refused)
{
    struct image image;
    CHECK(!read_exr("/", &image));
    CHECK(!read_png("/", &image));
    CHECK(!read_exr("/nowhere/in.exr", &image));
    CHECK(!read_png("/nowhere/in.png", &image));
    CHECK(strstr(test_last_message(), "/nowhere/in.png"));
    CHECK(test_host()->failure == FAIL_FILE);
}
