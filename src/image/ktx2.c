// Sections of a file: header, index, level index, data format descriptor, key/value data, level 0.
// All numbers are little-endian.
#include "image/ktx2.h"

#include "core/files/file.h"
#include "image/rgb9e5.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VK_FORMAT_E5B9G9R9 = 123, TEXEL_BYTES = 4, MAX_ENTRIES = 16 };
enum { HEADER_BYTES = 80, LEVEL_INDEX_BYTES = 24, SAMPLES = 6 };
enum { BLOCK_BYTES = 24 + 16 * SAMPLES, DESCRIPTOR_BYTES = 4 + BLOCK_BYTES };

static const uint8_t IDENTIFIER[12] = { 0xAB, 'K',  'T',  'X',  ' ',  '2',
                                        '0',  0xBB, '\r', '\n', 0x1A, '\n' };
// Rows go down, as in the file; the first row is at v = 0.
static const struct ktx2_entry FIXED[] = { { "KTXorientation", "rd" },
                                           { "KTXwriter", "afterglow" } };
enum { FIXED_COUNT = sizeof FIXED / sizeof FIXED[0] };

static void put_u32(struct file_writer *file, uint32_t value)
{
    const uint8_t bytes[4] = { (uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                               (uint8_t)(value >> 24) };
    file_write(file, bytes, sizeof bytes);
}

static void put_u64(struct file_writer *file, uint64_t value)
{
    put_u32(file, (uint32_t)value);
    put_u32(file, (uint32_t)(value >> 32));
}

// ---- metadata

static size_t entry_bytes(const struct ktx2_entry *entry) // key and value with their zeros
{
    return strlen(entry->key) + strlen(entry->value) + 2;
}

static size_t padded(size_t bytes)
{
    return (bytes + 3) & ~(size_t)3;
}

static int by_key(const void *a, const void *b)
{
    return strcmp(((const struct ktx2_entry *)a)->key, ((const struct ktx2_entry *)b)->key);
}

// In the order of their keys, as the format demands. Returns the number of bytes.
static size_t gather_entries(const struct ktx2_entry *given, int count, struct ktx2_entry *out)
{
    size_t bytes = 0;
    memcpy(out, FIXED, sizeof FIXED);
    if (count > 0) memcpy(out + FIXED_COUNT, given, (size_t)count * sizeof *given);
    qsort(out, (size_t)(FIXED_COUNT + count), sizeof *out, by_key);
    for (int i = 0; i < FIXED_COUNT + count; i++) bytes += 4 + padded(entry_bytes(&out[i]));
    return bytes;
}

static void put_entry(struct file_writer *file, const struct ktx2_entry *entry)
{
    const size_t bytes = entry_bytes(entry);
    put_u32(file, (uint32_t)bytes);
    file_write(file, entry->key, strlen(entry->key) + 1);
    file_write(file, entry->value, strlen(entry->value) + 1);
    file_write(file, "\0\0\0", padded(bytes) - bytes);
}

// ---- header and descriptor

static void put_header(struct file_writer *file, const struct image *image, size_t entries)
{
    file_write(file, IDENTIFIER, sizeof IDENTIFIER);
    put_u32(file, VK_FORMAT_E5B9G9R9);
    put_u32(file, TEXEL_BYTES); // bytes of a word
    put_u32(file, (uint32_t)image->width);
    put_u32(file, (uint32_t)image->height);
    put_u32(file, 0); // depth: 2D
    put_u32(file, 0); // layers: no array
    put_u32(file, 1); // faces
    put_u32(file, 1); // levels
    put_u32(file, 0); // no supercompression
    put_u32(file, HEADER_BYTES + LEVEL_INDEX_BYTES);
    put_u32(file, DESCRIPTOR_BYTES);
    put_u32(file, HEADER_BYTES + LEVEL_INDEX_BYTES + DESCRIPTOR_BYTES);
    put_u32(file, (uint32_t)entries);
    put_u64(file, 0); // no global data of a supercompression
    put_u64(file, 0);
    const uint64_t bytes = (uint64_t)image->width * (uint64_t)image->height * TEXEL_BYTES;
    put_u64(file, HEADER_BYTES + LEVEL_INDEX_BYTES + DESCRIPTOR_BYTES + entries);
    put_u64(file, bytes);
    put_u64(file, bytes);
}

// A colour's mantissa and the exponent that it shares (Khronos Data Format Specification, example
// of the format). The upper limit stands for 1: mantissa 256, and exponent 16 above its nine bits.
static void put_samples(struct file_writer *file, uint32_t channel)
{
    enum { EXPONENT = 0x20 };
    put_u32(file, 9 * channel | (9u - 1) << 16 | channel << 24);
    put_u32(file, 0);    // at the texel's origin
    put_u32(file, 0);    // lower
    put_u32(file, 8448); // upper
    put_u32(file, 27u | (5u - 1) << 16 | (channel | EXPONENT) << 24);
    put_u32(file, 0);
    put_u32(file, 15); // bias
    put_u32(file, 31);
}

static void put_descriptor(struct file_writer *file)
{
    enum { VERSION = 2, MODEL_RGBSDA = 1, PRIMARIES_BT709 = 1, TRANSFER_LINEAR = 1 };
    put_u32(file, DESCRIPTOR_BYTES);
    put_u32(file, 0); // Khronos, basic descriptor
    put_u32(file, VERSION | BLOCK_BYTES << 16);
    put_u32(file, MODEL_RGBSDA | PRIMARIES_BT709 << 8 | TRANSFER_LINEAR << 16);
    put_u32(file, 0);           // blocks of one texel
    put_u32(file, TEXEL_BYTES); // of plane 0
    put_u32(file, 0);
    for (uint32_t channel = 0; channel < 3; channel++) put_samples(file, channel);
}

// ---- texels

static void put_texels(struct file_writer *file, const struct image *image, float scale)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        const float *in = image->pixels + 3 * i;
        const float rgb[3] = { in[0] / scale, in[1] / scale, in[2] / scale };
        put_u32(file, rgb9e5_pack(rgb));
    }
}

float ktx2_scale(const struct image *image)
{
    const size_t count = 3 * (size_t)image->width * (size_t)image->height;
    float most = 0.0f;
    int exponent = 0;
    for (size_t i = 0; i < count; i++) most = fmaxf(most, image->pixels[i]);
    if (most > RGB9E5_MAX)
        frexpf(most / RGB9E5_MAX, &exponent);
    else if (most > 0.0f && most < 1.0f)
        frexpf(most, &exponent);
    return ldexpf(1.0f, exponent);
}

bool ktx2_write(struct host *host, const char *path, const struct image *image, float scale,
                const struct ktx2_entry *given, int count)
{
    struct ktx2_entry entries[MAX_ENTRIES];
    struct file_writer file = { 0 };
    if (image->channels != 3 || count > MAX_ENTRIES - FIXED_COUNT)
        return host_fail(host, FAIL_ARGUMENT, "%s: KTX2 of %d channels and %d entries", path,
                         image->channels, count);
    const size_t bytes = gather_entries(given, count, entries);
    if (!file_begin(&file, host, path)) return false;
    put_header(&file, image, bytes);
    put_descriptor(&file);
    for (int i = 0; i < FIXED_COUNT + count; i++) put_entry(&file, &entries[i]);
    put_texels(&file, image, scale);
    return file_commit(&file);
}
