// safetensors files: what is written is read, and nothing else is.
#include "bake/safetensors.h"

#include "core/files/file.h"
#include "framework/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float FLOATS[6] = { 1, 2, 3, 4, 5, 6.5f };
static const uint8_t BYTES[3] = { 7, 8, 9 };
static const uint16_t HALVES[2] = { 0x3c00, 0xc000 };
static const int32_t INTEGER = -5;

static const struct tensor SAMPLE[] = {
    { "mask", TENSOR_U8, 1, { 3 }, BYTES, sizeof BYTES },
    { "cube/1/U_b", TENSOR_F32, 2, { 2, 3 }, FLOATS, sizeof FLOATS },
    { "half", TENSOR_F16, 2, { 1, 2 }, HALVES, sizeof HALVES },
    { "scalar \"ü\"", TENSOR_I32, 0, { 0 }, &INTEGER, sizeof INTEGER },
    { "empty", TENSOR_U32, 2, { 4, 0 }, NULL, 0 },
};
static const struct tensor_metadata METADATA[] = { { "afterglow.technique", "test" },
                                                   { "afterglow.options", "a=1,b=\\2" } };

static const char *write_sample(void)
{
    const char *path = test_path("sample.safetensors");
    const struct tensors set = { SAMPLE, 5, METADATA, 2 };
    CHECK(safetensors_write(test_host(), path, &set));
    return path;
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    fwrite(bytes, 1, size, writer.stream);
    CHECK(file_commit(&writer));
}

TEST(safetensors_reads_what_was_written)
{
    struct safetensors file;
    CHECK(safetensors_read(test_host(), write_sample(), &file));
    CHECK(file.set.count == 5 && file.set.metadata_count == 2);
    for (int i = 0; i < 5; i++) {
        const struct tensor *t = tensors_find(&file.set, SAMPLE[i].name);
        CHECK(t && t->type == SAMPLE[i].type && t->rank == SAMPLE[i].rank);
        CHECK(t->bytes == SAMPLE[i].bytes);
        CHECK(t->bytes == 0 || memcmp(t->data, SAMPLE[i].data, t->bytes) == 0);
        CHECK(memcmp(t->shape, SAMPLE[i].shape, sizeof t->shape) == 0);
    }
    CHECK_STRING(tensors_metadata(&file.set, "afterglow.options"), "a=1,b=\\2");
    CHECK(!tensors_metadata(&file.set, "afterglow.none") && !tensors_find(&file.set, "none"));
    safetensors_finish(test_host(), &file);
}

TEST(safetensors_of_nothing_is_a_valid_file)
{
    const char *path = test_path("nothing.safetensors");
    const struct tensors none = { 0 };
    struct safetensors file;
    CHECK(safetensors_write(test_host(), path, &none));
    CHECK(safetensors_read(test_host(), path, &file) && file.set.count == 0);
    safetensors_finish(test_host(), &file);
}

TEST(safetensors_refuses_to_write_a_name_twice_or_not_in_utf8)
{
    const char *path = test_path("twice.safetensors");
    const struct tensor twice[] = { SAMPLE[1], SAMPLE[1] },
                        latin = { "\xfc", TENSOR_U8, 0, { 0 }, BYTES, 1 };
    const struct tensors a = { twice, 2, NULL, 0 }, b = { &latin, 1, NULL, 0 };
    CHECK(!safetensors_write(test_host(), path, &a));
    CHECK(strstr(test_last_message(), "the name cube/1/U_b occurs twice"));
    CHECK(!safetensors_write(test_host(), path, &b));
    struct safetensors file;
    CHECK(!safetensors_read(test_host(), path, &file)); // nothing was left
}

TEST(safetensors_cut_at_any_length_is_refused)
{
    struct file_bytes bytes;
    struct safetensors file;
    CHECK(file_read(test_host(), write_sample(), 0, &bytes));
    const char *path = test_path("cut.safetensors");
    for (size_t size = 0; size < bytes.size; size++) {
        test_forget_messages();
        write_bytes(path, bytes.data, size);
        CHECK(!safetensors_read(test_host(), path, &file) && file.set.count == 0);
        CHECK(strstr(test_last_message(), path));
    }
    file_bytes_finish(test_host(), &bytes);
}

// A changed byte may give another valid file (a letter of a name); every tensor must still lie
// inside it.
TEST(safetensors_with_any_changed_byte_is_refused_or_still_within_its_file)
{
    static const int CHANGES[] = { 1, 2, 4, 8, 16, 32, 64, 128, 255 };
    struct file_bytes bytes;
    CHECK(file_read(test_host(), write_sample(), 0, &bytes));
    const char *path = test_path("changed.safetensors");
    unsigned sum = 0;
    size_t refused = 0;
    for (size_t i = 0; i < bytes.size; i++)
        for (size_t k = 0; k < sizeof CHANGES / sizeof CHANGES[0]; k++) {
            struct safetensors file;
            bytes.data[i] = (uint8_t)(bytes.data[i] ^ CHANGES[k]);
            write_bytes(path, bytes.data, bytes.size);
            bytes.data[i] = (uint8_t)(bytes.data[i] ^ CHANGES[k]);
            if (!safetensors_read(test_host(), path, &file)) refused++;
            for (size_t t = 0; t < file.set.count; t++) {
                const uint8_t *data = file.set.at[t].data;
                for (size_t b = 0; b < file.set.at[t].bytes; b++) sum += data[b];
            }
            safetensors_finish(test_host(), &file);
        }
    CHECK(refused > 1000 && sum > 0);
    file_bytes_finish(test_host(), &bytes);
}

// A file of this header, padded to 8, and `data_size` zero bytes.
static bool read_header(const char *header, size_t data_size)
{
    unsigned char bytes[1024] = { 0 };
    struct safetensors file;
    const char *path = test_path("header.safetensors");
    const size_t length = (strlen(header) + 7) / 8 * 8;
    memset(bytes, ' ', sizeof bytes);
    memset(bytes, 0, 8);
    bytes[0] = (unsigned char)length;
    bytes[1] = (unsigned char)(length >> 8);
    memcpy(bytes + 8, header, strlen(header));
    memset(bytes + 8 + length, 0, data_size);
    test_forget_messages();
    write_bytes(path, bytes, 8 + length + data_size);
    const bool ok = safetensors_read(test_host(), path, &file);
    safetensors_finish(test_host(), &file);
    return ok;
}

TEST(safetensors_refuses_hostile_headers_with_the_tensor_and_the_reason)
{
    static const struct {
        const char *header, *message;
    } cases[] = {
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[0,8]},"
          "\"b\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[4,12]}}",
          "tensor b does not follow the one before it" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[0,8]},"
          "\"b\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[12,16]}}",
          "tensor b does not follow the one before it" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0,16]},"
          "\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0,16]}}",
          "duplicate object key" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[5],\"data_offsets\":[0,16]}}",
          "tensor a has another extent than its shape" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4294967296,4294967296,1],"
          "\"data_offsets\":[0,16]}}",
          "tensor a has another extent than its shape" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4611686018427387908],\"data_offsets\":[0,16]}}",
          "tensor a has another extent than its shape" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0,9223372036854775807]}}",
          "tensor a lies outside the file" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[16,0]}}",
          "tensor a does not follow" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0]}}", "no data_offsets" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[-4],\"data_offsets\":[0,16]}}", "no shape" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4.0],\"data_offsets\":[0,16]}}", "no shape" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[1,1,1,1,1,1,1,1,4],\"data_offsets\":[0,16]}}",
          "no shape of at most 8" },
        { "{\"a\":{\"dtype\":\"I64\",\"shape\":[2],\"data_offsets\":[0,16]}}",
          "tensor a has an unknown dtype" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0,16],\"x\":1}}",
          "is not described by" },
        { "{\"a\":[0,16]}", "is not described by" },
        { "{\"\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0,16]}}", "has no name" },
        { "{\"a\":{\"dtype\":\"F32\",\"shape\":[3],\"data_offsets\":[0,12]}}",
          "bytes follow the last tensor" },
        { "{\"a\":{\"dtype\":\"U8\",\"shape\":[12],\"data_offsets\":[0,12]},"
          "\"b\":{\"dtype\":\"U8\",\"shape\":[1],\"data_offsets\":[12,13]},"
          "\"c\":{\"dtype\":\"U16\",\"shape\":[1],\"data_offsets\":[13,15]}}",
          "tensor c is not aligned" },
        { "{\"__metadata__\":{\"a\":1}}", "value that is not text" },
        { "{\"__metadata__\":[]}", "__metadata__ is not an object" },
        { "[]", "not a JSON object" },
        { "{} {}", "not valid JSON" },
        { "{\"a\\u0000\":{}}", "not valid JSON" },
    };
    CHECK(read_header("{\"a\":{\"dtype\":\"F32\",\"shape\":[4],\"data_offsets\":[0,16]}}", 16));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        CHECK(!read_header(cases[i].header, 16));
        if (!strstr(test_last_message(), cases[i].message))
            fail_msg("%s: \"%s\" lacks \"%s\"", cases[i].header, test_last_message(),
                     cases[i].message);
    }
}

TEST(safetensors_refuses_a_header_over_16_mib_without_reading_it)
{
    const uint64_t lengths[] = { (16 << 20) + 8, UINT64_MAX, UINT64_MAX - 7, (uint64_t)1 << 63 };
    const char *path = test_path("long.safetensors");
    struct safetensors file;
    for (int i = 0; i < 4; i++) {
        write_bytes(path, &lengths[i], 8);
        CHECK(!safetensors_read(test_host(), path, &file));
        CHECK(strstr(test_last_message(), "larger than 16 MiB"));
    }
}

TEST(tensors_that_are_not_finite_are_found)
{
    float floats[3] = { 1, -2, 3 };
    uint16_t halves[2] = { 0x7bff, 0x0001 };
    double doubles[2] = { 1e300, -0.0 };
    const struct tensor f = { "f", TENSOR_F32, 1, { 3 }, floats, sizeof floats };
    const struct tensor d = { "d", TENSOR_F64, 1, { 2 }, doubles, sizeof doubles };
    const struct tensor h = { "h", TENSOR_F16, 1, { 2 }, halves, sizeof halves };
    CHECK(tensor_is_finite(&f) && tensor_is_finite(&h) && tensor_is_finite(&d));
    floats[2] = NAN;
    halves[1] = 0xfc00; // −∞
    doubles[1] = (double)INFINITY;
    CHECK(!tensor_is_finite(&f) && !tensor_is_finite(&h) && !tensor_is_finite(&d));
}

TEST(tensors_expect_names_the_tensor_and_the_difference)
{
    float floats[6] = { 0 };
    const struct tensor f = { "cube/U", TENSOR_F32, 2, { 2, 3 }, floats, sizeof floats };
    const struct tensors set = { &f, 1, NULL, 0 };
    const uint64_t right[] = { 2, 3 }, wrong[] = { 3, 2 };
    CHECK(tensors_expect(test_host(), &set, "cube/U", TENSOR_F32, 2, right) == floats);
    CHECK(!tensors_expect(test_host(), &set, "cube/U", TENSOR_F32, 2, wrong));
    CHECK_STRING(test_last_message(),
                 "cannot use the bake: tensor cube/U is F32 [2, 3], not F32 [3, 2]; bake again");
    CHECK(!tensors_expect(test_host(), &set, "cube/U", TENSOR_U32, 2, right));
    CHECK(!tensors_expect(test_host(), &set, "cube/V", TENSOR_F32, 2, right));
    CHECK_STRING(test_last_message(), "cannot use the bake: it has no tensor cube/V; bake again");
    floats[5] = INFINITY;
    CHECK(!tensors_expect(test_host(), &set, "cube/U", TENSOR_F32, 2, right));
    CHECK(strstr(test_last_message(), "not finite"));
}

// safetensors_python.sh names the file and reads it.
TEST(safetensors_sample_for_other_readers)
{
    const char *given = getenv("AFTERGLOW_SAFETENSORS_SAMPLE");
    const struct tensors set = { SAMPLE, 5, METADATA, 2 };
    CHECK(safetensors_write(test_host(), given ? given : test_path("sample.safetensors"), &set));
}
