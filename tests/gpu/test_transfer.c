// Uploads, downloads, conversion to float, zero initialisation.
#include "framework/gpu_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void fill(uint8_t *bytes, size_t count, uint32_t seed)
{
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        bytes[i] = (uint8_t)(seed >> 24);
    }
}

// Copies may change the bits of a NaN; a small exponent avoids them.
static void avoid_nan(enum gpu_format format, uint8_t *bytes, size_t count)
{
    bool half = format == GPU_R16F || format == GPU_RG16F || format == GPU_RGBA16F;
    bool single =
        format == GPU_R32F || format == GPU_RG32F || format == GPU_RGBA32F || format == GPU_D32F;
    for (size_t i = 0; i < count; i++) {
        if ((half && i % 2 == 1) || (single && i % 4 == 3)) bytes[i] &= 0x3b;
    }
}

static uint32_t shrink(uint32_t size, uint32_t mip)
{
    return size >> mip ? size >> mip : 1;
}

static void check_identity(struct gpu *gpu, enum gpu_dimension dimension, enum gpu_format format,
                           uint32_t depth)
{
    enum { SIZE = 12, MIPS = 3 };
    gpu_image image = test_gpu_image(gpu, dimension, format, SIZE, SIZE, depth, MIPS, GPU_SAMPLED);
    uint32_t layers = dimension == GPU_3D ? 1 : depth;
    uint8_t sent[SIZE * SIZE * 16 * 16], got[sizeof sent];
    for (int pass = 0; pass < 2; pass++) { // all uploads before the first download
        for (uint32_t layer = 0; layer < layers; layer++) {
            for (uint32_t mip = 0; mip < MIPS; mip++) {
                uint32_t slices = dimension == GPU_3D ? shrink(depth, mip) : 1;
                size_t bytes = (size_t)gpu_format_bytes(format) * shrink(SIZE, mip) *
                               shrink(SIZE, mip) * slices;
                assert_true(bytes <= sizeof sent);
                fill(sent, bytes, 1 + layer * MIPS + mip);
                avoid_nan(format, sent, bytes);
                if (pass == 0) {
                    CHECK(gpu_image_upload(gpu, image, mip, layer, sent, bytes));
                } else {
                    CHECK(gpu_image_download(gpu, image, mip, layer, got, bytes));
                    assert_memory_equal(sent, got, bytes);
                }
            }
        }
    }
    gpu_image_destroy(gpu, &image);
}

TEST_GPU(uploads_are_downloaded_unchanged_in_every_format)
{
    for (enum gpu_format f = GPU_R8; f < GPU_FORMAT_COUNT; f++) check_identity(gpu, GPU_2D, f, 1);
}

TEST_GPU(uploads_are_downloaded_unchanged_in_every_dimension)
{
    check_identity(gpu, GPU_2D_ARRAY, GPU_RG16F, 3);
    check_identity(gpu, GPU_3D, GPU_RGBA16F, 10);
    check_identity(gpu, GPU_CUBE, GPU_R32U, 6);
    check_identity(gpu, GPU_CUBE_ARRAY, GPU_D32F, 12);
}

TEST_GPU(partial_buffer_uploads_keep_the_rest)
{
    uint8_t expected[1003], got[1003];
    gpu_buffer buffer = test_gpu_buffer(gpu, sizeof expected);
    assert_int_equal(gpu_buffer_bytes(gpu, buffer), sizeof expected);
    memset(expected, 0, sizeof expected); // new buffers are zero
    fill(expected + 17, 500, 3);
    CHECK(gpu_buffer_upload(gpu, buffer, 17, expected + 17, 500));
    fill(expected + 999, 4, 4);
    CHECK(gpu_buffer_upload(gpu, buffer, 999, expected + 999, 4));
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    assert_memory_equal(expected, got, sizeof got);
    CHECK(gpu_buffer_download(gpu, buffer, 501, got, 101));
    assert_memory_equal(expected + 501, got, 101);
    gpu_buffer_destroy(gpu, &buffer);
}

// Leaves nonzero bytes in freed memory, so that a new object is not zero by chance.
static void dirty_memory(struct gpu *gpu)
{
    gpu_buffer buffer = test_gpu_buffer(gpu, 1 << 20);
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_RGBA32F, 256, 256, 1, 1, GPU_SAMPLED);
    uint8_t *bytes = malloc(1 << 20);
    memset(bytes, 0xcd, 1 << 20);
    CHECK(gpu_buffer_upload(gpu, buffer, 0, bytes, 1 << 20));
    CHECK(gpu_image_upload(gpu, image, 0, 0, bytes, 1 << 20));
    free(bytes);
    gpu_buffer_destroy(gpu, &buffer);
    gpu_image_destroy(gpu, &image);
    CHECK(gpu_wait(gpu));
}

TEST_GPU(new_images_are_zero_in_every_format)
{
    for (enum gpu_format f = GPU_R8; f < GPU_FORMAT_COUNT; f++) {
        dirty_memory(gpu);
        gpu_image image = test_gpu_image(gpu, GPU_2D_ARRAY, f, 16, 16, 3, 2, GPU_SAMPLED);
        uint8_t got[16 * 16 * 16];
        for (uint32_t layer = 0; layer < 3; layer++) {
            size_t bytes = (size_t)gpu_format_bytes(f) * 8 * 8;
            CHECK(gpu_image_download(gpu, image, 1, layer, got, bytes));
            for (size_t i = 0; i < bytes; i++) assert_int_equal(got[i], 0);
        }
        gpu_image_destroy(gpu, &image);
    }
}

TEST_GPU(new_buffers_are_zero)
{
    dirty_memory(gpu);
    uint8_t got[4099];
    gpu_buffer buffer = test_gpu_buffer(gpu, sizeof got);
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    for (size_t i = 0; i < sizeof got; i++) assert_int_equal(got[i], 0);
    gpu_buffer_destroy(gpu, &buffer);
}

TEST_GPU(a_partial_upload_leaves_the_rest_of_an_image_zero)
{
    dirty_memory(gpu);
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_R32U, 4, 4, 1, 2, GPU_STORAGE);
    uint32_t ones[16], got[4];
    memset(ones, 0xff, sizeof ones);
    CHECK(gpu_image_upload(gpu, image, 0, 0, ones, sizeof ones));
    CHECK(gpu_image_download(gpu, image, 1, 0, got, sizeof got));
    for (int i = 0; i < 4; i++) assert_int_equal(got[i], 0);
    gpu_image_destroy(gpu, &image);
}

static void check_float(struct gpu *gpu, enum gpu_format format, const void *texel,
                        const float expected[4])
{
    float got[4];
    gpu_image image = test_gpu_image(gpu, GPU_2D, format, 1, 1, 1, 1, GPU_SAMPLED);
    CHECK(gpu_image_upload(gpu, image, 0, 0, texel, (size_t)gpu_format_bytes(format)));
    CHECK(gpu_image_download_float(gpu, image, 0, 0, got, 4, 4));
    for (int c = 0; c < 4; c++) CHECK_RELATIVE(got[c], expected[c], 1e-6);
    gpu_image_destroy(gpu, &image);
}

TEST_GPU(every_format_converts_to_float)
{
    check_float(gpu, GPU_R8, (uint8_t[]){ 51 }, (float[]){ 0.2f, 0, 0, 1 });
    check_float(gpu, GPU_RG8, (uint8_t[]){ 0, 255 }, (float[]){ 0, 1, 0, 1 });
    check_float(gpu, GPU_RGBA8, (uint8_t[]){ 255, 51, 102, 153 }, (float[]){ 1, 0.2f, 0.4f, 0.6f });
    // 188 is the sRGB code nearest to one half; the other two lie on both sides of the linear toe.
    check_float(gpu, GPU_RGBA8_SRGB, (uint8_t[]){ 188, 10, 11, 51 },
                (float[]){ 0.50288646f, 0.003035270f, 0.003346536f, 0.2f });
    check_float(gpu, GPU_RGBA8_SNORM, (int8_t[]){ -128, -127, 127, 0 }, (float[]){ -1, -1, 1, 0 });
    check_float(gpu, GPU_RG16_SNORM, (int16_t[]){ -32768, 16384 },
                (float[]){ -1, 16384.0f / 32767, 0, 1 });
    // 1, the smallest subnormal, the most negative finite value, 1/3 rounded.
    check_float(gpu, GPU_RGBA16F, (uint16_t[]){ 0x3c00, 0x0001, 0xfbff, 0x3555 },
                (float[]){ 1, 5.9604645e-8f, -65504, 0.33325195f });
    check_float(gpu, GPU_RG16F, (uint16_t[]){ 0x7c00, 0x8400 },
                (float[]){ INFINITY, -6.1035156e-5f, 0, 1 });
    check_float(gpu, GPU_R16F, (uint16_t[]){ 0x4900 }, (float[]){ 10, 0, 0, 1 });
    check_float(gpu, GPU_RG32F, (float[]){ 3.5f, -1e-30f }, (float[]){ 3.5f, -1e-30f, 0, 1 });
    check_float(gpu, GPU_RGBA32U, (uint32_t[]){ 7, 1u << 30, 0, 1 },
                (float[]){ 7, 1073741824.0f, 0, 1 });
    check_float(gpu, GPU_D32F, (float[]){ 0.75f }, (float[]){ 0.75f, 0, 0, 1 });
    // 11-bit 1.0 (15 << 6), 11-bit 1.5 (15 << 6 | 32), 10-bit 2.0 (16 << 5).
    uint32_t packed = 15u << 6 | (15u << 6 | 32u) << 11 | (16u << 5) << 22;
    check_float(gpu, GPU_B10G11R11F, &packed, (float[]){ 1, 1.5f, 2, 1 });
}

TEST_GPU(mips_are_means_of_four_texels)
{
    gpu_image image = test_gpu_image(gpu, GPU_2D_ARRAY, GPU_RGBA8, 4, 4, 2, 3, GPU_SAMPLED);
    uint8_t texels[16][4];
    float got[4];
    for (uint32_t layer = 0; layer < 2; layer++) {
        for (uint32_t i = 0; i < 16; i++) {
            for (uint32_t c = 0; c < 4; c++) texels[i][c] = (uint8_t)(i * 4 + c + 100 * layer);
        }
        CHECK(gpu_image_upload(gpu, image, 0, layer, texels, sizeof texels));
    }
    CHECK(gpu_image_generate_mips(gpu, image));
    CHECK(gpu_image_download_float(gpu, image, 2, 1, got, 4, 4));
    for (int c = 0; c < 4; c++) CHECK_NEAR(got[c] * 255, 7.5 * 4 + c + 100, 1);
    gpu_image_destroy(gpu, &image);
}

TEST_GPU(transfers_of_a_wrong_size_or_range_are_refused)
{
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_RGBA8, 4, 4, 1, 1, GPU_SAMPLED);
    gpu_buffer buffer = test_gpu_buffer(gpu, 64), none = { 0 };
    uint8_t bytes[128];
    float floats[64];
    assert_false(gpu_image_upload(gpu, image, 0, 0, bytes, 63));
    assert_non_null(strstr(test_last_message(), "test.image"));
    assert_false(gpu_image_upload(gpu, image, 1, 0, bytes, 16));
    assert_false(gpu_image_download(gpu, image, 0, 1, bytes, 64));
    assert_false(gpu_image_download_float(gpu, image, 0, 0, floats, 4, 63));
    assert_false(gpu_image_download_float(gpu, image, 0, 0, floats, 5, 64));
    assert_false(gpu_buffer_upload(gpu, buffer, 1, bytes, 64));
    assert_false(gpu_buffer_download(gpu, buffer, SIZE_MAX, bytes, 2));
    assert_false(gpu_buffer_download(gpu, none, 0, bytes, 2));
    gpu_image_destroy(gpu, &image);
    gpu_buffer_destroy(gpu, &buffer);
    assert_false(gpu_buffer_download(gpu, buffer, 0, bytes, 2));
}

TEST_GPU(transfers_within_a_frame_are_refused)
{
    gpu_buffer buffer = test_gpu_buffer(gpu, 64);
    uint8_t bytes[64] = { 0 };
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    assert_false(gpu_buffer_upload(gpu, buffer, 0, bytes, 64));
    assert_non_null(strstr(test_last_message(), "frame is being recorded"));
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_buffer_destroy(gpu, &buffer);
}

TEST_GPU(a_readback_returns_a_frames_bytes_once_the_frame_is_done)
{
    const uint32_t wanted[4] = { 1, 2, 3, 4 };
    uint32_t got[4] = { 0 };
    gpu_buffer buffer;
    struct gpu_readback readback;
    const struct gpu_buffer_desc desc = { .name = "test.words",
                                          .bytes = sizeof wanted,
                                          .usage = GPU_BUFFER_STORAGE };
    CHECK(gpu_buffer_create(gpu, &desc, &buffer));
    CHECK(gpu_readback_create(gpu, "test.readback", sizeof got, &readback));
    CHECK(gpu_buffer_upload(gpu, buffer, 0, wanted, sizeof wanted));
    CHECK(!gpu_readback_poll(gpu, &readback, got, sizeof got));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_readback_copy(cmd, &readback, 0, buffer, 8, 8);
    gpu_readback_copy(cmd, &readback, 8, buffer, 0, 8);
    CHECK(!gpu_readback_poll(gpu, &readback, got, sizeof got)); // not even submitted
    gpu_fill_buffer(cmd, buffer, 0, sizeof wanted, 9);          // after the copies
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_wait(gpu));
    CHECK(gpu_readback_poll(gpu, &readback, got, sizeof got));
    CHECK(got[0] == 3 && got[1] == 4 && got[2] == 1 && got[3] == 2);
    CHECK(!gpu_readback_poll(gpu, &readback, got, sizeof got)); // each copy is returned once
    gpu_readback_destroy(gpu, &readback);
    gpu_buffer_destroy(gpu, &buffer);
}
